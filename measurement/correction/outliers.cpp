#include "measurement/correction/outliers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "forward/base/error.h"
#include "measurement/correction/plane.h"

namespace mezzotint {

namespace {

constexpr float missing = std::numeric_limits<float>::quiet_NaN();

// Of samples that were taken, how many have a neighbour along their row that was taken too.
double share_in_company(const HeightField& before, const HeightField& after) {
  std::size_t taken = 0, in_company = 0;
  const auto is_taken = [&](std::size_t i) {
    return std::isnan(after.heights_um()[i]) && !std::isnan(before.heights_um()[i]);
  };
  for (std::size_t row = 0; row < before.rows(); ++row) {
    bool last = false, counted = false;
    for (std::size_t column = 0; column < before.columns(); ++column) {
      const bool now = is_taken(row * before.columns() + column);
      taken += now ? 1 : 0;
      if (now && last) in_company += counted ? 1 : 2;
      counted = now && last;
      last = now;
    }
  }
  return taken > 0 ? static_cast<double>(in_company) / static_cast<double>(taken) : 0.0;
}

// What errors of an instrument look like: few, and mostly alone. A feature is neither.
void judge(const HeightField& before, OutlierResult& result) {
  const auto measured = static_cast<double>(before.grid().size() - before.missing_count());
  result.share = static_cast<double>(result.removed) / measured;
  const double together = share_in_company(before, result.field);
  constexpr double many = 3.0, mostly = 0.7, noticeable = 1e-3;
  // Three times the scatter of a count, so that a few samples of a small field are no ground for a warning.
  const double by_chance = result.expected_share + 3.0 * std::sqrt(result.expected_share / measured);
  const bool too_many = result.share > many * by_chance && result.share > noticeable;
  if (!too_many || together < mostly) return;
  result.warning = fmt::format(
      "{:.3g} % of the samples ({}) lie beyond the limit, where Gaussian heights have {:.2g} %, and {:.0f} % of them "
      "lie "
      "side by side: they look like features of the surface, not like errors. Raise the limit, or look for spikes with "
      "the local criterion",
      100.0 * result.share, result.removed, 100.0 * result.expected_share, 100.0 * together);
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
  std::ranges::copy_if(off, std::back_inserter(sizes), [](float value) { return !std::isnan(value); });
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
  OutlierResult result{field};
  for (std::size_t i = 0; i < field.grid().size(); ++i) {
    if (!(std::abs(static_cast<double>(levelled.heights_um()[i])) > limit_um)) continue;
    result.field.heights_um()[i] = missing;
    ++result.removed;
  }
  result.expected_share = std::erfc(k / std::numbers::sqrt2);
  judge(field, result);
  return result;
}

OutlierResult mask_local_outliers(const HeightField& field, double k) {
  require(k >= 1.0 && k <= 1000.0,
          fmt::format("local outliers lie between 1 and 1000 standard deviations off; {} is outside", k));
  std::vector<float> off(field.grid().size());
  tbb::parallel_for(std::size_t{0}, field.rows(), [&](std::size_t row) {
    for (std::size_t column = 0; column < field.columns(); ++column)
      off[row * field.columns() + column] = std::abs(field.at(column, row) - median_around(field, column, row));
  });
  OutlierResult result{field};
  result.expected_share = std::erfc(k / std::numbers::sqrt2);
  const double limit_um = k * typical_size(field, off);
  for (std::size_t i = 0; i < off.size(); ++i) {
    if (!(static_cast<double>(off[i]) > limit_um)) continue;
    result.field.heights_um()[i] = missing;
    ++result.removed;
  }
  judge(field, result);
  return result;
}

}  // namespace mezzotint
