#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace mezzotint {

/// What deflate can do at best: 258 bytes from 2 bits. A promise beyond it is a lie, and is refused before memory
/// is taken for it.
inline constexpr std::size_t best_deflate_ratio = 1032;

/// Unpacks a zlib stream that must fill `unpacked` to the last byte.
/// @return what is wrong, in words; empty where all is well
[[nodiscard]] std::string inflate_exactly(std::span<const std::byte> packed, std::span<std::byte> unpacked);

}  // namespace mezzotint
