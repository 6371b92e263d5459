#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace mezzotint {

/// Appends numbers in little-endian order, whatever the order of this machine.
template <class Number>
void append_little_endian(std::string& bytes, Number value) {
  using Bits =
      std::conditional_t<sizeof(Number) == 8, std::uint64_t,
                         std::conditional_t<sizeof(Number) == 4, std::uint32_t,
                                            std::conditional_t<sizeof(Number) == 2, std::uint16_t, std::uint8_t>>>;
  Bits bits;
  std::memcpy(&bits, &value, sizeof value);
  for (std::size_t i = 0; i < sizeof value; ++i) bytes.push_back(static_cast<char>(bits >> (8 * i) & 0xFF));
}

/// Appends many at once.
template <class Number>
void append_little_endian(std::string& bytes, std::span<const Number> values) {
  if constexpr (std::endian::native == std::endian::little)
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  else
    for (const Number value : values) append_little_endian(bytes, value);
}

/// Puts a number or a text at a place of a header.
template <class Number>
void put_little_endian(std::string& bytes, std::size_t at, Number value) {
  std::string number;
  append_little_endian(number, value);
  bytes.replace(at, number.size(), number);
}
inline void put_text(std::string& bytes, std::size_t at, std::size_t room, std::string_view text) {
  text = text.substr(0, room);
  bytes.replace(at, text.size(), text);
}

}  // namespace mezzotint
