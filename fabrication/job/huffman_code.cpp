#include "fabrication/job/huffman_code.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <queue>

namespace mezzotint {

namespace {

constexpr int longest_code = 15;

struct Node {
  std::uint64_t count;
  std::size_t index;  ///< of a symbol, or of a joint node after all symbols; decides between equal counts
};

struct Heavier {
  bool operator()(const Node& a, const Node& b) const {
    return a.count != b.count ? a.count > b.count : a.index > b.index;
  }
};

// Depths in the tree that joins the two rarest again and again.
std::vector<std::uint8_t> depths(const std::vector<std::uint64_t>& counts) {
  std::priority_queue<Node, std::vector<Node>, Heavier> open;
  for (std::size_t symbol = 0; symbol < counts.size(); ++symbol) {
    if (counts[symbol] > 0) open.push({counts[symbol], symbol});
  }
  std::vector<std::uint8_t> lengths(counts.size(), 0);
  if (open.size() == 1) lengths[open.top().index] = 1;
  std::vector<std::size_t> parents(counts.size(), 0);
  while (open.size() > 1) {
    const Node a = open.top();
    open.pop();
    const Node b = open.top();
    open.pop();
    parents[a.index] = parents[b.index] = parents.size();
    open.push({a.count + b.count, parents.size()});
    parents.push_back(0);
  }
  std::vector<std::uint8_t> depth(parents.size(), 0);
  if (parents.size() == counts.size()) return lengths;  // no joint node
  for (std::size_t node = parents.size() - 1; node-- > 0;) {
    if (node < counts.size() && counts[node] == 0) continue;
    depth[node] = static_cast<std::uint8_t>(depth[parents[node]] + 1);
    if (node < counts.size()) lengths[node] = depth[node];
  }
  return lengths;
}

std::uint16_t reversed(unsigned code, int length) {
  unsigned result = 0;
  for (int i = 0; i < length; ++i) result |= ((code >> i) & 1U) << (length - 1 - i);
  return static_cast<std::uint16_t>(result);
}

}  // namespace

HuffmanCode huffman_code(std::vector<std::uint64_t> counts, int most_bits) {
  HuffmanCode code;
  code.lengths = depths(counts);
  while (*std::max_element(code.lengths.begin(), code.lengths.end()) > most_bits) {
    for (std::uint64_t& count : counts) count = count == 0 ? 0 : count / 2 + 1;
    code.lengths = depths(counts);
  }
  std::array<unsigned, longest_code + 2> first = {};
  for (const std::uint8_t length : code.lengths) {
    if (length > 0) ++first[length + 1U];
  }
  // first[n + 1] held how many codes have n bits; now first[n] becomes the first code of n bits.
  for (std::size_t n = 1; n < first.size(); ++n) first[n] = (first[n - 1] + first[n]) << 1U;
  code.bits.assign(counts.size(), 0);
  for (std::size_t symbol = 0; symbol < counts.size(); ++symbol) {
    const int length = code.lengths[symbol];
    if (length > 0) code.bits[symbol] = reversed(first[static_cast<std::size_t>(length)]++, length);
  }
  return code;
}

}  // namespace mezzotint
