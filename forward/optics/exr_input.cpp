#include "forward/optics/exr_input.h"

#include "forward/base/error.h"
#include "forward/base/file_input.h"
#include "forward/optics/exr_header.h"

namespace mezzotint {

namespace {

// 4096² bins of eight floats, that zip could not make smaller, and a header.
constexpr std::uintmax_t largest_file_bytes = std::uintmax_t{600} << 20;

}  // namespace

ExrInput open_exr(const std::filesystem::path& path) {
  std::error_code ignored;
  const std::uintmax_t size = std::filesystem::file_size(path, ignored);
  if (!ignored && size > largest_file_bytes) throw FileError(path, "", "is larger than any direction map");
  ExrInput input;
  input.bytes = read_file(path);
  require_sound_exr_header(input.bytes, path);
  input.memory = std::make_unique<BoundedMemory>(input.bytes.data(), input.bytes.size());
  input.file = OIIO::ImageInput::create("exr", false, nullptr, input.memory.get());
  if (!input.file) throw DeviceError("cannot read " + path.string() + ": OpenImageIO has no OpenEXR here");
  if (!input.file->open(path.string(), input.spec)) throw FileError(path, "header", input.file->geterror());
  return input;
}

}  // namespace mezzotint
