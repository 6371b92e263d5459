#include "measurement/reflectance/reflectance_file.h"

#include <fstream>

#include "forward/base/error.h"
#include "forward/base/file_input.h"
#include "measurement/reflectance/reflectance_parsers.h"
#include "measurement/reflectance/tensor_file.h"

namespace mezzotint {

namespace {

using Bytes = std::span<const std::byte>;

struct Format {
  bool (*looks_like)(Bytes);
  MeasuredReflectance (*parse)(const std::filesystem::path&, Bytes);
};

constexpr Format formats[] = {{looks_like_tensor_file, parse_rgl}, {looks_like_merl, parse_merl},
                              {looks_like_zemax, parse_zemax},     {looks_like_fred, parse_fred},
                              {looks_like_cornell, parse_cornell}, {looks_like_alta, parse_alta}};
// Enough for the comments at the head of a text.
constexpr std::size_t head_bytes = std::size_t{64} << 10U;

const Format* format_of(Bytes head) {
  for (const Format& format : formats) {
    if (format.looks_like(head)) return &format;
  }
  return nullptr;
}

}  // namespace

bool is_reflectance_file(const std::filesystem::path& path) {
  // A pipe would be waited for.
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return false;
  std::ifstream stream(path, std::ios::binary);
  std::vector<char> head(head_bytes);
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(stream.gcount()));
  return format_of(std::as_bytes(std::span(head))) != nullptr;
}

MeasuredReflectance read_reflectance(const std::filesystem::path& path) {
  const std::vector<std::byte> bytes = read_file(path);
  const Format* format = format_of(Bytes(bytes).first(std::min(bytes.size(), head_bytes)));
  if (format == nullptr) {
    throw FileError(path, "",
                    "is no measured BRDF that is known: an RGL tensor (.bsdf), MERL (.binary), or the text of Zemax, "
                    "FRED, Cornell or ALTA");
  }
  return format->parse(path, bytes);
}

}  // namespace mezzotint
