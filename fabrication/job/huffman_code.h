#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace mezzotint {

/// A prefix code of deflate: for each symbol its bits, the first one lowest, and how many; 0 for a symbol that does
/// not occur.
struct HuffmanCode {
  std::vector<std::uint8_t> lengths;
  std::vector<std::uint16_t> bits;
};

/// The code that packs symbols of these counts best, no code longer than `most_bits`. Codes that would be longer
/// are brought down by halving the counts, which costs next to nothing.
/// Source   Huffman 1952; canonical codes of RFC 1951, 3.2.2.
[[nodiscard]] HuffmanCode huffman_code(std::vector<std::uint64_t> counts, int most_bits);

}  // namespace mezzotint
