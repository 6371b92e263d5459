#include "measurement/correction/outliers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "forward/base/error.h"
#include "forward/surface/row_bands.h"
#include "measurement/correction/plane.h"
#include "measurement/correction/plane_rows.h"

namespace mezzotint {

namespace {

constexpr float missing = std::numeric_limits<float>::quiet_NaN();

// Of columns in ascending order, how many have a neighbour among them.
std::size_t in_company(std::span<const std::uint32_t> columns) {
  std::size_t count = 0;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const bool left = k > 0 && columns[k] - columns[k - 1] == 1;
    const bool right = k + 1 < columns.size() && columns[k + 1] - columns[k] == 1;
    count += left || right ? 1 : 0;
  }
  return count;
}

/// What was taken out, and how much of it has a neighbour along its row that was taken too.
struct Taken {
  std::size_t count = 0, in_company = 0;
  Taken& operator+=(const Taken& other) {
    count += other.count;
    in_company += other.in_company;
    return *this;
  }
};

// find(row, columns): appends the columns of a row's outliers, in ascending order.
template <class Find>
Taken take_out(HeightField& field, const Find& find) {
  return sum_of_bands(field.rows(), Taken{}, [&](std::size_t first, std::size_t end) {
    Taken taken;
    std::vector<std::uint32_t> columns;
    for (std::size_t row = first; row < end; ++row) {
      columns.clear();
      find(row, columns);
      for (const std::uint32_t column : columns) field.at(column, row) = missing;
      taken += {columns.size(), in_company(columns)};
    }
    return taken;
  });
}

// What errors of an instrument look like: few, and mostly alone. A feature is neither.
void judge(double measured, const Taken& taken, OutlierResult& result) {
  result.removed = taken.count;
  result.share = static_cast<double>(taken.count) / measured;
  const double together =
      taken.count > 0 ? static_cast<double>(taken.in_company) / static_cast<double>(taken.count) : 0.0;
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

OutlierResult mask_outliers(HeightField field, double k) {
  require(k >= 1.0 && k <= 100.0,
          fmt::format("outliers lie between 1 and 100 standard deviations off; {} is outside", k));
  const Plane plane = fit_plane(field);  // the mean above it is zero
  const double squares = sum_of_bands(field.rows(), 0.0, [&](std::size_t first, std::size_t end) {
    double sum = 0.0;
    for (std::size_t row = first; row < end; ++row)
      sum += squares_above_line(row_of(std::as_const(field), row), line_of(plane, field, row));
    return sum;
  });
  const auto measured = static_cast<double>(field.grid().size() - field.missing_count());
  const double limit_um = k * std::sqrt(squares / measured);
  OutlierResult result{std::move(field)};
  const Taken taken = take_out(result.field, [&](std::size_t row, std::vector<std::uint32_t>& columns) {
    find_beyond(row_of(std::as_const(result.field), row), line_of(plane, result.field, row), limit_um, columns);
  });
  result.expected_share = std::erfc(k / std::numbers::sqrt2);
  judge(measured, taken, result);
  return result;
}

OutlierResult mask_local_outliers(HeightField field, double k) {
  require(k >= 1.0 && k <= 1000.0,
          fmt::format("local outliers lie between 1 and 1000 standard deviations off; {} is outside", k));
  std::vector<float> off(field.grid().size());
  tbb::parallel_for(std::size_t{0}, field.rows(), [&](std::size_t row) {
    for (std::size_t column = 0; column < field.columns(); ++column)
      off[row * field.columns() + column] = std::abs(field.at(column, row) - median_around(field, column, row));
  });
  const auto measured = static_cast<double>(field.grid().size() - field.missing_count());
  const double limit_um = k * typical_size(field, off);
  OutlierResult result{std::move(field)};
  const Taken taken = take_out(result.field, [&](std::size_t row, std::vector<std::uint32_t>& columns) {
    const std::size_t begin = row * result.field.columns();
    for (std::size_t column = 0; column < result.field.columns(); ++column)
      if (static_cast<double>(off[begin + column]) > limit_um) columns.push_back(static_cast<std::uint32_t>(column));
  });
  result.expected_share = std::erfc(k / std::numbers::sqrt2);
  judge(measured, taken, result);
  return result;
}

}  // namespace mezzotint
