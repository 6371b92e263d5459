#include "measurement/texture/roughness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "forward/base/error.h"
#include "forward/surface/row_bands.h"
#include "measurement/texture/block_jackknife.h"
#include "measurement/texture/blocks.h"
#include "measurement/texture/roughness_rows.h"

namespace mezzotint {

namespace {

template <class Value>
using PerBlock = std::array<Value, block_count>;

/// One sum for each block.
template <class Sums>
struct BlockSums {
  PerBlock<Sums> blocks{};

  BlockSums& operator+=(const BlockSums& other) {
    for (std::size_t j = 0; j < block_count; ++j) blocks[j] += other.blocks[j];
    return *this;
  }
};

// visit(sums of a block, heights): all stretches of rows that lie in one block.
template <class Sums, class Visit>
PerBlock<Sums> sums_in_blocks(const HeightField& field, const Visit& visit) {
  return sum_of_bands(field.rows(), BlockSums<Sums>{},
                      [&](std::size_t first, std::size_t end) {
                        BlockSums<Sums> sums;
                        for (std::size_t row = first; row < end; ++row) {
                          const std::size_t above = blocks_a_side * block_along(row, field.rows());
                          for_each_block_along(
                              field.columns(), [&](std::size_t block, std::size_t begin, std::size_t behind) {
                                visit(sums.blocks[above + block],
                                      field.heights_um().subspan(row * field.columns() + begin, behind - begin));
                              });
                        }
                        return sums;
                      })
      .blocks;
}

struct CentralMoments {
  double mean = 0.0, rms = 0.0, skewness = 0.0, kurtosis = 0.0;
};

// About the mean of the set itself. A flat set has no shape: 0/0 is NaN there.
CentralMoments central_moments(const PowerSums& sums) {
  const double d = sums.first / sums.count;
  const double s2 = sums.second / sums.count, s3 = sums.third / sums.count, s4 = sums.fourth / sums.count;
  const double variance = std::max(0.0, s2 - d * d);
  const double third = s3 - 3.0 * d * s2 + 2.0 * d * d * d;
  const double fourth = s4 - 4.0 * d * s3 + 6.0 * d * d * s2 - 3.0 * d * d * d * d;
  return {d, std::sqrt(variance), third / (variance * std::sqrt(variance)), fourth / (variance * variance)};
}

template <class Sums>
Sums total_of(const PerBlock<Sums>& blocks) {
  Sums total;
  for (const Sums& block : blocks) total += block;
  return total;
}

template <class Sums>
PerBlock<double> counts_of(const PerBlock<Sums>& blocks) {
  PerBlock<double> counts{};
  std::transform(blocks.begin(), blocks.end(), counts.begin(), [](const Sums& sums) { return sums.count; });
  return counts;
}

// A statistic of all blocks, with the standard error from leaving out each in turn.
template <class Sums, class Statistic>
Quantity estimate(const PerBlock<Sums>& blocks, const char* unit, const Statistic& statistic) {
  const Sums total = total_of(blocks);
  PerBlock<double> without{};
  for (std::size_t j = 0; j < block_count; ++j) without[j] = statistic(total.without(blocks[j]));
  const double whole = statistic(total);
  return {whole, unit, jackknife_standard_error(whole, without, counts_of(blocks))};
}

/// Σ |z − mean| about the mean of all blocks, and about that of all but each.
struct Deviations {
  std::array<double, reference_count> sums{};
  Deviations& operator+=(const Deviations& other) {
    for (std::size_t k = 0; k < reference_count; ++k) sums[k] += other.sums[k];
    return *this;
  }
};

// The mean that Sa refers to moves when a block is left out, so each needs a sum of its own.
Quantity mean_deviation(const HeightField& field, double mean, const PerBlock<PowerSums>& heights) {
  static_assert(reference_count == block_count + 1);
  const PowerSums total = total_of(heights);
  std::array<double, reference_count> references{};
  for (std::size_t j = 0; j < block_count; ++j) references[j] = mean + central_moments(total.without(heights[j])).mean;
  references[block_count] = mean + central_moments(total).mean;
  const auto blocks = sums_in_blocks<Deviations>(field, [&](Deviations& sums, std::span<const float> heights_um) {
    add_deviations(heights_um, references, sums.sums);
  });
  const Deviations all = total_of(blocks);
  PerBlock<double> without{};
  for (std::size_t j = 0; j < block_count; ++j)
    without[j] = (all.sums[j] - blocks[j].sums[j]) / (total.count - heights[j].count);
  const double whole = all.sums[block_count] / total.count;
  return {whole, "µm", jackknife_standard_error(whole, without, counts_of(heights))};
}

// The row behind, for a period that closes: its first sample again at its end.
std::vector<float> closed(std::span<const float> row_um) {
  std::vector<float> closed_um(row_um.begin(), row_um.end());
  closed_um.push_back(row_um.front());
  return closed_um;
}

// A periodic field has the cells that close it.
PerBlock<SlopeSums> slopes_in_blocks(const HeightField& field) {
  const std::size_t closing = field.periodic() ? 0 : 1;
  const std::size_t columns = field.columns() - closing, rows = field.rows() - closing;
  const double per_x = 1.0 / field.grid().pitch_x.um(), per_y = 1.0 / field.grid().pitch_y.um();
  const auto row_at = [&](std::size_t row) {
    const auto row_um = field.heights_um().subspan(row % field.rows() * field.columns(), field.columns());
    return field.periodic() ? closed(row_um) : std::vector<float>(row_um.begin(), row_um.end());
  };
  return sum_of_bands(rows, BlockSums<SlopeSums>{},
                      [&](std::size_t first, std::size_t end) {
                        BlockSums<SlopeSums> sums;
                        std::vector<float> low = row_at(first), high;
                        for (std::size_t row = first; row < end; ++row) {
                          high = row_at(row + 1);
                          const std::size_t above = blocks_a_side * block_along(row, rows);
                          for_each_block_along(columns, [&](std::size_t block, std::size_t begin, std::size_t behind) {
                            const auto part = [&](const std::vector<float>& row_um) {
                              return std::span(row_um).subspan(begin, behind - begin + 1);
                            };
                            sums.blocks[above + block] += slope_sums(part(low), part(high), per_x, per_y);
                          });
                          low.swap(high);
                        }
                        return sums;
                      })
      .blocks;
}

PerBlock<PowerSums> powers_in_blocks(const HeightField& field, double reference_um) {
  return sums_in_blocks<PowerSums>(
      field, [&](PowerSums& sums, std::span<const float> heights_um) { sums += power_sums(heights_um, reference_um); });
}

// Any measured height will do to begin with: sums about it lose no digits to an offset.
double mean_um(const HeightField& field) {
  const auto heights_um = field.heights_um();
  const auto first = std::ranges::find_if(heights_um, [](float z) { return !std::isnan(z); });
  const double start = first == heights_um.end() ? 0.0 : static_cast<double>(*first);
  const PowerSums sums = total_of(powers_in_blocks(field, start));
  require(sums.count >= 4.0, "roughness needs four measured samples at least");
  return start + sums.first / sums.count;
}

}  // namespace

AreaRoughness area_roughness(const HeightField& field) {
  const double mean = mean_um(field);
  const PerBlock<SlopeSums> slopes = slopes_in_blocks(field);
  require(total_of(slopes).count > 0.0, "no cell with four measured corners: the relief has no slopes");
  const PerBlock<PowerSums> heights = powers_in_blocks(field, mean);
  const HeightRange range = height_range(field);
  AreaRoughness result;
  result.Sa = mean_deviation(field, mean, heights);
  result.Sq = estimate(heights, "µm", [](const PowerSums& sums) { return central_moments(sums).rms; });
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  result.Sp = {range.highest.um() - mean, "µm", nan};
  result.Sv = {mean - range.lowest.um(), "µm", nan};
  result.Sz = {(range.highest - range.lowest).um(), "µm", nan};
  result.Ssk = estimate(heights, "1", [](const PowerSums& sums) { return central_moments(sums).skewness; });
  result.Sku = estimate(heights, "1", [](const PowerSums& sums) { return central_moments(sums).kurtosis; });
  result.Sdq = estimate(slopes, "1", [](const SlopeSums& sums) { return std::sqrt(sums.squares / sums.count); });
  result.Sdr = estimate(slopes, "1", [](const SlopeSums& sums) { return sums.area_excess / sums.count; });
  result.missing = field.missing_count();
  result.samples = field.grid().size() - result.missing;
  return result;
}

}  // namespace mezzotint
