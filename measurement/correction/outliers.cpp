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

// Of columns in ascending order: whether one is among them.
bool holds(const std::vector<std::uint32_t>& columns, std::uint32_t column) {
  return std::ranges::binary_search(columns, column);
}

/// What was taken out: columns in ascending order, row by row; and how many of them lie above what they were compared
/// to.
struct Taken {
  std::vector<std::vector<std::uint32_t>> columns;
  std::size_t above = 0;

  [[nodiscard]] std::size_t count() const {
    std::size_t sum = 0;
    for (const auto& row : columns) sum += row.size();
    return sum;
  }
  /// How many have a neighbour that was taken too.
  [[nodiscard]] std::size_t in_company() const {
    return sum_of_bands(columns.size(), std::size_t{0}, [this](std::size_t first, std::size_t end) {
      std::size_t sum = 0;
      for (std::size_t row = first; row < end; ++row)
        for (const std::uint32_t column : columns[row]) sum += has_company(row, column) ? 1 : 0;
      return sum;
    });
  }

private:
  [[nodiscard]] bool has_company(std::size_t row, std::uint32_t column) const {
    const bool beside = holds(columns[row], column + 1) || (column > 0 && holds(columns[row], column - 1));
    return beside || (row > 0 && holds(columns[row - 1], column)) ||
           (row + 1 < columns.size() && holds(columns[row + 1], column));
  }
};

// find(row, columns): appends the columns of a row's outliers, in ascending order, and tells how many lie above.
template <class Find>
Taken take_out(HeightField& field, const Find& find) {
  Taken taken{std::vector<std::vector<std::uint32_t>>(field.rows())};
  taken.above = sum_of_bands(field.rows(), std::size_t{0}, [&](std::size_t first, std::size_t end) {
    std::size_t above = 0;
    for (std::size_t row = first; row < end; ++row) {
      above += find(row, taken.columns[row]);
      for (const std::uint32_t column : taken.columns[row]) field.at(column, row) = missing;
    }
    return above;
  });
  return taken;
}

// What errors of an instrument look like: few, and mostly alone. A feature is neither; and where there are as many as
// Gaussian heights have, but all on one side, they are features too.
void judge(double measured, const Taken& taken, OutlierResult& result) {
  result.removed = taken.count();
  if (result.removed == 0) return;
  const auto removed = static_cast<double>(result.removed);
  result.share = removed / measured;
  const double together = static_cast<double>(taken.in_company()) / removed;
  const double above = static_cast<double>(taken.above) / removed;
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
    const RowLine line = line_of(plane, result.field, row);
    find_beyond(row_of(std::as_const(result.field), row), line, limit_um, columns);
    return std::ranges::count_if(columns, [&](std::uint32_t column) {
      return static_cast<double>(result.field.at(column, row)) > line.first_um + line.rise_um * column;
    });
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
      off[row * field.columns() + column] = field.at(column, row) - median_around(field, column, row);
  });
  const auto measured = static_cast<double>(field.grid().size() - field.missing_count());
  const double limit_um = k * typical_size(field, off);
  OutlierResult result{std::move(field)};
  const Taken taken = take_out(result.field, [&](std::size_t row, std::vector<std::uint32_t>& columns) {
    const std::span<const float> off_row = std::span(off).subspan(row * result.field.columns(), result.field.columns());
    for (std::size_t column = 0; column < off_row.size(); ++column)
      if (std::abs(static_cast<double>(off_row[column])) > limit_um)
        columns.push_back(static_cast<std::uint32_t>(column));
    return std::ranges::count_if(columns, [&](std::uint32_t column) { return off_row[column] > 0.0F; });
  });
  result.expected_share = std::erfc(k / std::numbers::sqrt2);
  judge(measured, taken, result);
  return result;
}

}  // namespace mezzotint
