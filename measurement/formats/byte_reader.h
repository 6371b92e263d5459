#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace mezzotint {

/// A number from its little-endian bytes, whatever the order of this machine. `bytes` holds sizeof(Number).
template <class Number>
[[nodiscard]] Number little_endian(const std::byte* bytes) {
  if constexpr (std::endian::native == std::endian::little) {
    Number number;
    std::memcpy(&number, bytes, sizeof number);
    return number;
  }
  using Bits =
      std::conditional_t<sizeof(Number) == 8, std::uint64_t,
                         std::conditional_t<sizeof(Number) == 4, std::uint32_t,
                                            std::conditional_t<sizeof(Number) == 2, std::uint16_t, std::uint8_t>>>;
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < sizeof(Number); ++i) bits |= std::to_integer<std::uint64_t>(bytes[i]) << (8 * i);
  const Bits narrow = static_cast<Bits>(bits);
  Number number;
  std::memcpy(&number, &narrow, sizeof number);
  return number;
}

/// Walks through a file's bytes (or through a part of them) and never past their end.
///
/// Errors   FileError with the byte's offset in the file when something asks for more than is there.
class ByteReader {
public:
  ByteReader(const std::filesystem::path& path, std::span<const std::byte> bytes) : path_(&path), bytes_(bytes) {}

  /// Offset of the next byte in the file, also where this reader sees only a part of it.
  [[nodiscard]] std::size_t offset() const { return base_ + position_; }
  [[nodiscard]] std::size_t remaining() const { return bytes_.size() - position_; }
  [[nodiscard]] const std::filesystem::path& path() const { return *path_; }

  /// The next `count` bytes; `what` names them in the complaint.
  std::span<const std::byte> take(std::uint64_t count, std::string_view what);
  /// The next `count` bytes as a reader of their own.
  ByteReader take_part(std::uint64_t count, std::string_view what);
  /// Text up to a NUL, which is taken too.
  std::string_view take_text(std::string_view what);

  template <class Number>
  Number take_number(std::string_view what) {
    return little_endian<Number>(take(sizeof(Number), what).data());
  }

  /// Complains about the next byte.
  [[noreturn]] void fail(std::string_view problem) const;

private:
  const std::filesystem::path* path_;
  std::span<const std::byte> bytes_;
  std::size_t base_ = 0;
  std::size_t position_ = 0;
};

/// Whether the bytes begin with these.
[[nodiscard]] bool begins_with(std::span<const std::byte> bytes, std::string_view magic);

/// "byte 1261"
[[nodiscard]] std::string byte_place(std::size_t offset);

}  // namespace mezzotint
