#include "fabrication/job/deflate_block.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "fabrication/job/huffman_code.h"

namespace mezzotint {

namespace {

constexpr std::size_t literal_symbols = 286, distance_symbols = 30, end_of_block = 256;
constexpr std::uint32_t longest_match = 258;
constexpr int most_code_bits = 15, most_length_code_bits = 7;

/// A number as deflate writes it: a symbol, and some further bits.
struct Coded {
  std::uint16_t symbol = 0;
  std::uint16_t extra = 0;
  std::uint8_t extra_bits = 0;
};

// RFC 1951, 3.2.5: four codes for each number of extra bits (two for distances), from the fifth (third) on.
Coded coded_length(std::uint32_t length) {
  if (length == longest_match) return {285, 0, 0};
  const std::uint32_t value = length - 3;
  if (value < 8) return {static_cast<std::uint16_t>(257 + value), 0, 0};
  const auto bits = static_cast<std::uint32_t>(std::bit_width(value) - 3);
  const std::uint32_t symbol = 257 + 4 * bits + (value >> bits);
  return {static_cast<std::uint16_t>(symbol), static_cast<std::uint16_t>(value & ((1U << bits) - 1)),
          static_cast<std::uint8_t>(bits)};
}

Coded coded_distance(std::uint64_t distance) {
  const auto value = static_cast<std::uint32_t>(distance - 1);
  if (value < 4) return {static_cast<std::uint16_t>(value), 0, 0};
  const auto bits = static_cast<std::uint32_t>(std::bit_width(value) - 2);
  return {static_cast<std::uint16_t>(2 * bits + (value >> bits)),
          static_cast<std::uint16_t>(value & ((1U << bits) - 1)), static_cast<std::uint8_t>(bits)};
}

// Matches of 258 bytes, then one or two that end the copy; none may be shorter than 3.
struct Matches {
  std::uint32_t longest = 0;
  std::array<std::uint32_t, 2> rest = {0, 0};
};

Matches matches_of(std::uint32_t length) {
  Matches matches;
  matches.longest = length / longest_match;
  const std::uint32_t left = length % longest_match;
  if (left == 0) return matches;
  if (left >= 3) {
    matches.rest[0] = left;
  } else {
    --matches.longest;
    matches.rest = {longest_match + left - 3, 3};
  }
  return matches;
}

// Bits into bytes, the first bit lowest.
class BitWriter {
public:
  explicit BitWriter(std::string& out) : out_(out), at_(out.size()) {}
  /// Up to 56 bits at a time.
  void put(std::uint64_t bits, int count) {
    buffer_ |= bits << filled_;
    filled_ += count;
    if (at_ + sizeof buffer_ > out_.size()) out_.resize(2 * out_.size() + 64);
    std::memcpy(out_.data() + at_, &buffer_, sizeof buffer_);  // little endian, as everything that we run on
    at_ += static_cast<std::size_t>(filled_ / 8);
    buffer_ >>= filled_ / 8 * 8;
    filled_ %= 8;
  }
  void finish() { out_.resize(at_ + (filled_ > 0 ? 1 : 0)); }

private:
  std::string& out_;
  std::size_t at_;
  std::uint64_t buffer_ = 0;
  int filled_ = 0;
};
static_assert(std::endian::native == std::endian::little);

struct Counts {
  std::vector<std::uint64_t> literals = std::vector<std::uint64_t>(literal_symbols, 0);
  std::vector<std::uint64_t> distances = std::vector<std::uint64_t>(distance_symbols, 0);
};

Counts count_symbols(std::span<const std::uint32_t> tokens, std::uint64_t stretch) {
  Counts counts;
  for (const std::uint32_t token : tokens) {
    if (token < copy_token) {
      ++counts.literals[token];
      continue;
    }
    const Matches matches = matches_of(token & longest_copy);
    std::uint64_t number = matches.longest;
    counts.literals[285] += matches.longest;
    for (const std::uint32_t length : matches.rest) {
      if (length == 0) continue;
      ++counts.literals[coded_length(length).symbol];
      ++number;
    }
    counts.distances[coded_distance((token & from_stretch) != 0 ? stretch : 1).symbol] += number;
  }
  counts.literals[end_of_block] = 1;
  // Two codes at least: a decoder may refuse an incomplete code.
  counts.distances[0] += 1;
  counts.distances[1] += 1;
  return counts;
}

// RFC 1951, 3.2.7: the lengths of both codes, packed by a third code. Zeros are bundled; there are many.
void put_codes(const HuffmanCode& literals, const HuffmanCode& distances, BitWriter& writer) {
  constexpr std::array<std::size_t, 19> order = {16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15};
  std::vector<std::uint8_t> lengths = literals.lengths;
  lengths.insert(lengths.end(), distances.lengths.begin(), distances.lengths.end());
  std::vector<Coded> symbols;
  for (std::size_t i = 0; i < lengths.size();) {
    std::size_t zeros = 0;
    while (i + zeros < lengths.size() && lengths[i + zeros] == 0 && zeros < 138) ++zeros;
    if (zeros < 3) {
      symbols.push_back({lengths[i], 0, 0});
      ++i;
    } else {
      symbols.push_back(zeros < 11 ? Coded{17, static_cast<std::uint16_t>(zeros - 3), 3}
                                   : Coded{18, static_cast<std::uint16_t>(zeros - 11), 7});
      i += zeros;
    }
  }
  std::vector<std::uint64_t> counts(order.size(), 0);
  for (const Coded& coded : symbols) ++counts[coded.symbol];
  const HuffmanCode code = huffman_code(counts, most_length_code_bits);
  writer.put(literal_symbols - 257, 5);
  writer.put(distance_symbols - 1, 5);
  writer.put(order.size() - 4, 4);
  for (const std::size_t symbol : order) writer.put(code.lengths[symbol], 3);
  for (const Coded& coded : symbols) {
    writer.put(code.bits[coded.symbol], code.lengths[coded.symbol]);
    writer.put(coded.extra, coded.extra_bits);
  }
}

struct PackedBits {
  std::uint64_t bits = 0;
  int count = 0;
  void append(std::uint64_t more, int number) {
    bits |= more << count;
    count += number;
  }
  void append(const HuffmanCode& code, const Coded& coded) {
    append(code.bits[coded.symbol], code.lengths[coded.symbol]);
    append(coded.extra, coded.extra_bits);
  }
};

PackedBits match_bits(const HuffmanCode& literals, const HuffmanCode& distances, std::uint32_t length,
                      const Coded& distance) {
  PackedBits packed;
  packed.append(literals, coded_length(length));
  packed.append(distances, distance);
  return packed;
}

}  // namespace

void append_block(std::span<const std::uint32_t> tokens, std::uint64_t stretch, std::string& out) {
  const Counts counts = count_symbols(tokens, stretch);
  const HuffmanCode literals = huffman_code(counts.literals, most_code_bits);
  const HuffmanCode distances = huffman_code(counts.distances, most_code_bits);
  const Coded one_back = coded_distance(1), stretch_back = coded_distance(std::max<std::uint64_t>(stretch, 1));
  BitWriter writer(out);
  writer.put(1, 1);  // the last block
  writer.put(2, 2);  // with codes of its own
  put_codes(literals, distances, writer);
  for (const std::uint32_t token : tokens) {
    if (token < copy_token) {
      writer.put(literals.bits[token], literals.lengths[token]);
      continue;
    }
    const Coded& distance = (token & from_stretch) != 0 ? stretch_back : one_back;
    const Matches matches = matches_of(token & longest_copy);
    const PackedBits longest = match_bits(literals, distances, longest_match, distance);
    for (std::uint32_t i = 0; i < matches.longest; ++i) writer.put(longest.bits, longest.count);
    for (const std::uint32_t length : matches.rest) {
      if (length == 0) continue;
      const PackedBits packed = match_bits(literals, distances, length, distance);
      writer.put(packed.bits, packed.count);
    }
  }
  writer.put(literals.bits[end_of_block], literals.lengths[end_of_block]);
  writer.finish();
}

}  // namespace mezzotint
