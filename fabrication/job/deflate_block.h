#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace mezzotint {

// Tokens of a deflate block: a literal byte, or a copy of `length` bytes, at least 3, from one byte back or from one
// stretch back. A copy may be longer than deflate's 258 bytes; it is cut when it is written.

inline constexpr std::uint32_t copy_token = std::uint32_t{1} << 31U;
inline constexpr std::uint32_t from_stretch = std::uint32_t{1} << 30U;
inline constexpr std::uint32_t longest_copy = from_stretch - 1;

/// Appends one final block, with the Huffman codes that suit it.
/// @param stretch  bytes of a stretch, up to 32768
void append_block(std::span<const std::uint32_t> tokens, std::uint64_t stretch, std::string& out);

}  // namespace mezzotint
