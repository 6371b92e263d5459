#include "measurement/texture/roughness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "forward/base/error.h"
#include "measurement/texture/block_jackknife.h"
#include "measurement/texture/blocks.h"

namespace mezzotint {

namespace {

template <class Value>
using PerBlock = std::array<Value, block_count>;

/// Sums over a set of samples of powers of the height above a reference.
struct PowerSums {
  double count = 0.0, first = 0.0, second = 0.0, third = 0.0, fourth = 0.0;

  void add(double z) {
    count += 1.0;
    first += z;
    second += z * z;
    third += z * z * z;
    fourth += z * z * z * z;
  }
  void add(const PowerSums& other) {
    count += other.count;
    first += other.first;
    second += other.second;
    third += other.third;
    fourth += other.fourth;
  }
  [[nodiscard]] PowerSums without(const PowerSums& part) const {
    return {count - part.count, first - part.first, second - part.second, third - part.third, fourth - part.fourth};
  }
};

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

double mean_um(const HeightField& field) {
  double sum = 0.0, count = 0.0;
  for_each_in_blocks(field, [&](std::size_t, double z) {
    sum += z;
    count += 1.0;
  });
  require(count >= 4.0, "roughness needs four measured samples at least");
  return sum / count;
}

template <class Sums>
Sums total_of(const PerBlock<Sums>& blocks) {
  Sums total;
  for (const Sums& block : blocks) total.add(block);
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

// The mean that Sa refers to moves when a block is left out, so each needs a sum of its own.
Quantity mean_deviation(const HeightField& field, double mean, const PerBlock<PowerSums>& blocks) {
  const PowerSums total = total_of(blocks);
  PerBlock<double> means_without{}, sums_without{};
  for (std::size_t j = 0; j < block_count; ++j) means_without[j] = central_moments(total.without(blocks[j])).mean;
  double sum = 0.0;
  for_each_in_blocks(field, [&](std::size_t block, double height) {
    const double z = height - mean;
    sum += std::abs(z - total.first / total.count);
    for (std::size_t j = 0; j < block_count; ++j) {
      sums_without[j] += j == block ? 0.0 : std::abs(z - means_without[j]);
    }
  });
  PerBlock<double> without{};
  for (std::size_t j = 0; j < block_count; ++j) without[j] = sums_without[j] / (total.count - blocks[j].count);
  const double whole = sum / total.count;
  return {whole, "µm", jackknife_standard_error(whole, without, counts_of(blocks))};
}

/// Sums over the triangles of whole cells.
struct SlopeSums {
  double count = 0.0, squares = 0.0, area_excess = 0.0;

  void add(double slope_x, double slope_y) {
    const double square = slope_x * slope_x + slope_y * slope_y;
    count += 1.0;
    squares += square;
    area_excess += square / (1.0 + std::sqrt(1.0 + square));  // √(1+s²) − 1 without cancellation
  }
  void add(const SlopeSums& other) {
    count += other.count;
    squares += other.squares;
    area_excess += other.area_excess;
  }
  [[nodiscard]] SlopeSums without(const SlopeSums& part) const {
    return {count - part.count, squares - part.squares, area_excess - part.area_excess};
  }
};

// The two triangles a cell of `to_mesh`; a periodic field has the cells that close it.
PerBlock<SlopeSums> slope_sums(const HeightField& field) {
  const std::size_t closing = field.periodic() ? 0 : 1;
  const std::size_t columns = field.columns() - closing, rows = field.rows() - closing;
  const double per_x = 1.0 / field.grid().pitch_x.um(), per_y = 1.0 / field.grid().pitch_y.um();
  PerBlock<SlopeSums> blocks;
  for (std::size_t row = 0; row < rows; ++row) {
    const std::size_t next_row = row + 1 == field.rows() ? 0 : row + 1;
    for (std::size_t column = 0; column < columns; ++column) {
      const std::size_t next = column + 1 == field.columns() ? 0 : column + 1;
      const double z00 = field.at(column, row), z10 = field.at(next, row);
      const double z01 = field.at(column, next_row), z11 = field.at(next, next_row);
      if (std::isnan(z00 + z10 + z01 + z11)) continue;
      SlopeSums& sums = blocks[blocks_a_side * block_along(row, rows) + block_along(column, columns)];
      sums.add((z10 - z00) * per_x, (z11 - z10) * per_y);
      sums.add((z11 - z01) * per_x, (z01 - z00) * per_y);
    }
  }
  return blocks;
}

PerBlock<PowerSums> power_sums(const HeightField& field, double mean) {
  PerBlock<PowerSums> blocks;
  for_each_in_blocks(field, [&](std::size_t block, double z) { blocks[block].add(z - mean); });
  return blocks;
}

}  // namespace

AreaRoughness area_roughness(const HeightField& field) {
  const double mean = mean_um(field);
  const PerBlock<SlopeSums> slopes = slope_sums(field);
  require(total_of(slopes).count > 0.0, "no cell with four measured corners: the relief has no slopes");
  const PerBlock<PowerSums> heights = power_sums(field, mean);
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
