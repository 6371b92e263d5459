#include "measurement/correction/outliers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "forward/base/error.h"
#include "measurement/correction/plane.h"

namespace mezzotint {

namespace {

constexpr float missing = std::numeric_limits<float>::quiet_NaN();

/// Of the samples that were taken: how many have a neighbour that was taken too.
double share_in_company(const HeightField& before, const HeightField& after) {
  const std::size_t columns = before.columns(), rows = before.rows();
  const auto is_taken = [&](std::size_t column, std::size_t row) {
    return std::isnan(after.at(column, row)) && !std::isnan(before.at(column, row));
  };
  std::size_t taken = 0, in_company = 0;
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t column = 0; column < columns; ++column) {
      if (!is_taken(column, row)) continue;
      ++taken;
      const bool beside =
          (column > 0 && is_taken(column - 1, row)) || (column + 1 < columns && is_taken(column + 1, row));
      const bool along = (row > 0 && is_taken(column, row - 1)) || (row + 1 < rows && is_taken(column, row + 1));
      in_company += beside || along ? 1 : 0;
    }
  return taken > 0 ? static_cast<double>(in_company) / static_cast<double>(taken) : 0.0;
}

// What errors of an instrument look like: few, and mostly alone. A feature is neither; and where there are as many as
// Gaussian heights have, but all on one side, they are features too.
void judge(const HeightField& before, double above, OutlierResult& result) {
  const auto measured = static_cast<double>(before.grid().size() - before.missing_count());
  result.share = static_cast<double>(result.removed) / measured;
  const double together = share_in_company(before, result.field);
  constexpr double many = 3.0, mostly = 0.7, noticeable = 1e-3, nearly_all = 0.95;
  // Three times the scatter of a count, so that a few samples of a small field are no ground for a warning.
  const double by_chance = result.expected_share + 3.0 * std::sqrt(result.expected_share / measured);
  const double one_side = std::max(above, 1.0 - above);
  const bool too_many = result.share > many * by_chance || (one_side > nearly_all && result.share > 0.5 * by_chance);
  if (!too_many || result.share <= noticeable || together < mostly) return;
  result.warning = fmt::format(
      "{:.3g} % of the samples ({}) lie beyond the limit, where Gaussian heights have {:.2g} %, {:.0f} % of them side "
      "by side and {:.0f} % on one side: they look like features of the surface, not like errors. Raise the limit, or "
      "look for spikes with the local criterion",
      100.0 * result.share, result.removed, 100.0 * result.expected_share, 100.0 * together, 100.0 * one_side);
}

// Median of the measured samples in the 5 × 5 samples around one, itself left out; NaN where there is none.
float median_around(const HeightField& field, std::size_t column, std::size_t row) {
  std::array<float, 24> values{};
  std::size_t count = 0;
  const std::size_t first_row = row < 2 ? 0 : row - 2, last_row = std::min(row + 2, field.rows() - 1);
  const std::size_t first = column < 2 ? 0 : column - 2, last = std::min(column + 2, field.columns() - 1);
  for (std::size_t r = first_row; r <= last_row; ++r)
    for (std::size_t c = first; c <= last; ++c) {
      if (r == row && c == column) continue;
      const float z = field.at(c, r);
      if (!std::isnan(z)) values[count++] = z;
    }
  if (count == 0) return missing;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(count / 2);
  std::nth_element(values.begin(), middle, values.begin() + static_cast<std::ptrdiff_t>(count));
  return *middle;
}

// Robust standard deviation of what is left of each sample. Quantised heights may leave nothing of most: their quantum
// takes its place, the smallest step between neighbours.
double typical_size(const HeightField& field, const std::vector<float>& off) {
  constexpr double robust = 1.4826;  // a Gaussian's deviation over its median absolute deviation
  std::vector<float> sizes;
  for (const float value : off)
    if (!std::isnan(value)) sizes.push_back(std::abs(value));
  if (sizes.empty()) return 0.0;
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  if (*middle > 0.0F) return robust * static_cast<double>(*middle);
  float quantum = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i + 1 < field.grid().size(); ++i) {
    const float step = std::abs(field.heights_um()[i + 1] - field.heights_um()[i]);
    if (step > 0.0F && (i + 1) % field.columns() != 0) quantum = std::min(quantum, step);
  }
  return static_cast<double>(quantum);
}

// The field without the samples that lie too far off.
OutlierResult without(const HeightField& field, std::span<const float> off_um, double limit_um, double k) {
  OutlierResult result{field};
  double above = 0.0;
  for (std::size_t i = 0; i < off_um.size(); ++i) {
    if (!(std::abs(static_cast<double>(off_um[i])) > limit_um)) continue;
    result.field.heights_um()[i] = missing;
    ++result.removed;
    above += off_um[i] > 0.0F ? 1.0 : 0.0;
  }
  result.expected_share = std::erfc(k / std::numbers::sqrt2);
  judge(field, above / std::max(1.0, static_cast<double>(result.removed)), result);
  return result;
}

}  // namespace

OutlierResult mask_outliers(const HeightField& field, double k) {
  require(k >= 1.0 && k <= 100.0,
          fmt::format("outliers lie between 1 and 100 standard deviations off; {} is outside", k));
  const HeightField levelled = level(field);  // its mean is zero
  double squares = 0.0, count = 0.0;
  for (const float z : levelled.heights_um()) {
    if (std::isnan(z)) continue;
    squares += static_cast<double>(z) * z;
    count += 1.0;
  }
  const double limit_um = k * std::sqrt(squares / count);
  return without(field, levelled.heights_um(), limit_um, k);
}

OutlierResult mask_local_outliers(const HeightField& field, double k) {
  require(k >= 1.0 && k <= 1000.0,
          fmt::format("local outliers lie between 1 and 1000 standard deviations off; {} is outside", k));
  std::vector<float> off(field.grid().size());
  tbb::parallel_for(std::size_t{0}, field.rows(), [&](std::size_t row) {
    for (std::size_t column = 0; column < field.columns(); ++column)
      off[row * field.columns() + column] = field.at(column, row) - median_around(field, column, row);
  });
  return without(field, off, k * typical_size(field, off), k);
}

}  // namespace mezzotint
