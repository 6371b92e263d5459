#include "measurement/reflectance/tensor_file.h"

#include <array>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "measurement/formats/byte_reader.h"

namespace mezzotint {

namespace {

constexpr std::string_view magic("tensor_file\0", 12);
constexpr std::uint32_t most_fields = 1000;
constexpr std::uint16_t most_dimensions = 8;
constexpr std::array<std::uint64_t, 12> type_sizes = {0, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};

TensorField take_field(ByteReader& reader, std::span<const std::byte> file) {
  const auto dimensions = reader.take_number<std::uint16_t>("number of dimensions");
  if (dimensions > most_dimensions)
    reader.fail(fmt::format("a field has {} dimensions; at most {} make sense", dimensions, most_dimensions));
  const auto type = reader.take_number<std::uint8_t>("type");
  if (type == 0 || type >= type_sizes.size()) reader.fail(fmt::format("a field has type {}; 1 to 11 are known", type));
  TensorField field{static_cast<TensorField::Type>(type), reader.take_number<std::uint64_t>("offset"), {}, {}};
  std::uint64_t size = type_sizes[type];
  for (std::uint16_t d = 0; d < dimensions; ++d) {
    const auto length = reader.take_number<std::uint64_t>("length of a dimension");
    if (length == 0 || length > file.size() / size)
      reader.fail(fmt::format("a field claims a dimension of {} in a file of {} bytes", length, file.size()));
    size *= length;
    field.shape.push_back(static_cast<std::size_t>(length));
  }
  if (field.offset > file.size() || size > file.size() - field.offset) {
    reader.fail(fmt::format("a field claims {} bytes from byte {}; the file has {}: it was cut off, or is damaged",
                            size, field.offset, file.size()));
  }
  field.bytes = file.subspan(static_cast<std::size_t>(field.offset), static_cast<std::size_t>(size));
  return field;
}

}  // namespace

bool looks_like_tensor_file(std::span<const std::byte> bytes) { return begins_with(bytes, magic); }

std::map<std::string, TensorField> tensor_fields(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  ByteReader reader(path, bytes);
  if (!looks_like_tensor_file(bytes)) reader.fail("is no tensor file; one begins with \"tensor_file\"");
  static_cast<void>(reader.take(magic.size(), "magic"));
  const auto major = reader.take_number<std::uint8_t>("version"), minor = reader.take_number<std::uint8_t>("version");
  if (major != 1 || minor != 0) reader.fail(fmt::format("has version {}.{}; 1.0 is read", major, minor));
  const auto count = reader.take_number<std::uint32_t>("number of fields");
  if (count > most_fields) reader.fail(fmt::format("claims {} fields; at most {} make sense", count, most_fields));
  std::map<std::string, TensorField> fields;
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto length = reader.take_number<std::uint16_t>("length of a name");
    const auto name = reader.take(length, "name of a field");
    const std::string text(reinterpret_cast<const char*>(name.data()), name.size());
    if (!fields.emplace(text, take_field(reader, bytes)).second) reader.fail("names one field twice");
  }
  return fields;
}

}  // namespace mezzotint
