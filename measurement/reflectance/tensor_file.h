#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

/// Inside of measurement/reflectance: the container of RGL measurements.

namespace mezzotint {

/// A named array of a tensor file; its bytes lie in those of the file.
struct TensorField {
  enum class Type : std::uint8_t {
    UInt8 = 1,
    Int8,
    UInt16,
    Int16,
    UInt32,
    Int32,
    UInt64,
    Int64,
    Float16,
    Float32,
    Float64
  };
  Type type;
  std::uint64_t offset;
  std::vector<std::size_t> shape;
  std::span<const std::byte> bytes;
};

/// "tensor_file\0", version 1.0, a table of fields, their data; all little-endian.
/// @throws FileError with the byte where the file is no tensor file, or claims more than it holds.
[[nodiscard]] std::map<std::string, TensorField> tensor_fields(const std::filesystem::path& path,
                                                               std::span<const std::byte> bytes);

[[nodiscard]] bool looks_like_tensor_file(std::span<const std::byte> bytes);

}  // namespace mezzotint
