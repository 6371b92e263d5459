#include "measurement/texture/height_counts.h"

#include <algorithm>
#include <array>

#include <tbb/parallel_for.h>

#include "measurement/texture/blocks.h"

namespace mezzotint {

void HeightCounts::add(std::span<const float> heights_um) {
  constexpr std::size_t piece = 256;
  const float per_um = static_cast<float>(bins) / (highest_um - lowest_um);
  constexpr float last = static_cast<float>(bins) - 1.0F;
  std::array<std::int32_t, piece> bin{};
  for (std::size_t begin = 0; begin < heights_um.size(); begin += piece) {
    const auto some = heights_um.subspan(begin, std::min(piece, heights_um.size() - begin));
    // A loop of its own, which the compiler makes vectors of. NaN compares as neither, and ends below 0.
    for (std::size_t k = 0; k < some.size(); ++k) {
      const float down = (highest_um - some[k]) * per_um, inside = down < last ? down : last;
      bin[k] = some[k] == some[k] ? static_cast<std::int32_t>(inside) : -1;
    }
    for (std::size_t k = 0; k < some.size(); ++k) {
      if (bin[k] < 0) continue;
      ++counts[static_cast<std::size_t>(bin[k])];
      ++samples;
    }
  }
}

HeightCounts& HeightCounts::operator+=(const HeightCounts& other) {
  std::ranges::transform(counts, other.counts, counts.begin(), std::plus<>());
  samples += other.samples;
  return *this;
}

HeightCounts& HeightCounts::operator-=(const HeightCounts& other) {
  std::ranges::transform(counts, other.counts, counts.begin(), std::minus<>());
  samples -= other.samples;
  return *this;
}

std::vector<HeightCounts> counts_in_blocks(const HeightField& field) {
  if (field.grid().size() - field.missing_count() <= BearingCurve::most_exact) return {};
  const HeightRange range = height_range(field);
  if (!(range.lowest < range.highest)) return {};
  const auto low = static_cast<float>(range.lowest.um()), high = static_cast<float>(range.highest.um());
  std::vector<HeightCounts> blocks(block_count, HeightCounts{high, low});
  tbb::parallel_for(std::size_t{0}, block_count, [&](std::size_t at) {
    for_each_block_along(field.rows(), [&](std::size_t block_row, std::size_t first, std::size_t end) {
      if (block_row != at / blocks_a_side) return;
      for_each_block_along(field.columns(), [&](std::size_t block_column, std::size_t begin, std::size_t behind) {
        if (block_column != at % blocks_a_side) return;
        for (std::size_t row = first; row < end; ++row)
          blocks[at].add(field.heights_um().subspan(row * field.columns() + begin, behind - begin));
      });
    });
  });
  // Heights that come in steps, or of which one lies far off, leave most bins empty: bins would round what is exact.
  constexpr std::ptrdiff_t least_filled = HeightCounts::bins / 16;
  const HeightCounts all = sum_of(blocks);
  const auto filled = std::ranges::count_if(all.counts, [](std::uint32_t count) { return count > 0; });
  return filled >= least_filled ? blocks : std::vector<HeightCounts>{};
}

HeightCounts sum_of(const std::vector<HeightCounts>& blocks) {
  HeightCounts sum = blocks.front();
  for (std::size_t k = 1; k < blocks.size(); ++k) sum += blocks[k];
  return sum;
}

}  // namespace mezzotint
