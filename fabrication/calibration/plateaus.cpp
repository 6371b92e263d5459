#include "fabrication/calibration/plateaus.h"

#include <algorithm>
#include <cmath>

namespace mezzotint {

namespace {

constexpr double outlier_deviations = 5.0;

double median_of(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Mean of the shortest half.
double shorth(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2 + 1;
  std::size_t best = 0;
  for (std::size_t i = 0; i + half <= values.size(); ++i) {
    if (values[i + half - 1] - values[i] < values[best + half - 1] - values[best]) best = i;
  }
  double sum = 0.0;
  for (std::size_t i = best; i < best + half; ++i) sum += values[i];
  return sum / static_cast<double>(half);
}

// A field and the plane that is taken from it.
struct Level {
  const HeightField& field;
  Tilt tilt;

  [[nodiscard]] double x_um(std::size_t column) const {
    return static_cast<double>(column) * field.grid().pitch_x.um();
  }
  [[nodiscard]] double y_um(std::size_t row) const { return static_cast<double>(row) * field.grid().pitch_y.um(); }
  [[nodiscard]] double at(std::size_t column, std::size_t row) const {
    return static_cast<double>(field.at(column, row)) - tilt.slope_x * x_um(column) - tilt.slope_y * y_um(row);
  }
};

// Heights between which a plateau's samples count.
struct Window {
  double low = 0.0, high = 0.0;
  [[nodiscard]] bool holds(double height) const { return height >= low && height <= high; }
};

std::vector<Window> windows(const Level& level, const std::vector<Patch>& patches, std::size_t plateaus) {
  std::vector<std::vector<double>> heights(plateaus);
  for (const Patch& patch : patches) {
    for (std::size_t row = patch.row; row < patch.row_end; ++row) {
      for (std::size_t column = patch.column; column < patch.column_end; ++column) {
        const double height = level.at(column, row);
        if (!std::isnan(height)) heights[patch.plateau].push_back(height);
      }
    }
  }
  std::vector<Window> found(plateaus);
  for (std::size_t i = 0; i < plateaus; ++i) {
    if (heights[i].empty()) continue;
    const double middle = median_of(heights[i]);
    for (double& height : heights[i]) height = std::abs(height - middle);
    // At least a nanometre, for a plateau without any roughness.
    const double reach = std::max(1e-3, outlier_deviations * 1.4826 * median_of(heights[i]));
    found[i] = {middle - reach, middle + reach};
  }
  return found;
}

struct Moments {
  double count = 0.0, x = 0.0, y = 0.0, z = 0.0, xx = 0.0, xy = 0.0, yy = 0.0, xz = 0.0, yz = 0.0, zz = 0.0;
  std::size_t outliers = 0;
};

std::vector<Moments> moments(const Level& level, const std::vector<Patch>& patches, const std::vector<Window>& window) {
  std::vector<Moments> sums(window.size());
  for (const Patch& patch : patches) {
    Moments& sum = sums[patch.plateau];
    for (std::size_t row = patch.row; row < patch.row_end; ++row) {
      const double y = level.y_um(row);
      for (std::size_t column = patch.column; column < patch.column_end; ++column) {
        const double z = level.at(column, row), x = level.x_um(column);
        if (std::isnan(z)) continue;
        if (!window[patch.plateau].holds(z)) {
          ++sum.outliers;
          continue;
        }
        sum.count += 1.0;
        sum.x += x;
        sum.y += y;
        sum.z += z;
        sum.xx += x * x;
        sum.xy += x * y;
        sum.yy += y * y;
        sum.xz += x * z;
        sum.yz += y * z;
        sum.zz += z * z;
      }
    }
  }
  return sums;
}

// What is left of the tilt within plateaus.
Tilt tilt_within(const std::vector<Moments>& sums) {
  double xx = 0.0, xy = 0.0, yy = 0.0, xz = 0.0, yz = 0.0;
  for (const Moments& s : sums) {
    if (s.count < 1.0) continue;
    xx += s.xx - s.x * s.x / s.count;
    xy += s.xy - s.x * s.y / s.count;
    yy += s.yy - s.y * s.y / s.count;
    xz += s.xz - s.x * s.z / s.count;
    yz += s.yz - s.y * s.z / s.count;
  }
  const double determinant = xx * yy - xy * xy;
  if (!(determinant > 1e-9 * xx * yy)) return {};
  return {(xz * yy - yz * xy) / determinant, (yz * xx - xz * xy) / determinant, 0.0};
}

// How far means over blocks scatter within their plateaus.
struct BlockScatter {
  double variance = 0.0;  ///< of a block's mean
  double blocks = 0.0, plateaus = 0.0;
};

BlockScatter scatter_of(const Level& level, const std::vector<Patch>& patches, const std::vector<Window>& window,
                        std::size_t side_x, std::size_t side_y) {
  struct Sum {
    double count = 0.0, mean = 0.0, square = 0.0;
  };
  std::vector<Sum> sums(window.size());
  for (const Patch& patch : patches) {
    for (std::size_t row = patch.row; row + side_y <= patch.row_end; row += side_y) {
      for (std::size_t column = patch.column; column + side_x <= patch.column_end; column += side_x) {
        double count = 0.0, height = 0.0;
        for (std::size_t r = row; r < row + side_y; ++r) {
          for (std::size_t c = column; c < column + side_x; ++c) {
            const double z = level.at(c, r);
            if (std::isnan(z) || !window[patch.plateau].holds(z)) continue;
            count += 1.0;
            height += z;
          }
        }
        if (count < 0.5 * static_cast<double>(side_x * side_y)) continue;
        Sum& sum = sums[patch.plateau];
        const double mean = height / count - 0.5 * (window[patch.plateau].low + window[patch.plateau].high);
        sum.count += 1.0;
        sum.mean += mean;
        sum.square += mean * mean;
      }
    }
  }
  BlockScatter scatter;
  for (const Sum& sum : sums) {
    if (sum.count < 2.0) continue;
    scatter.variance += sum.square - sum.mean * sum.mean / sum.count;
    scatter.blocks += sum.count;
    scatter.plateaus += 1.0;
  }
  const double freedom = scatter.blocks - scatter.plateaus;
  scatter.variance = freedom >= 1.0 ? scatter.variance / freedom : 0.0;
  return scatter;
}

// The largest variance of a mean, times its samples, that any size of block with enough blocks promises.
double correlated_variance(const Level& level, const std::vector<Patch>& patches, const std::vector<Window>& window) {
  constexpr double enough_freedom = 20.0;
  double largest = 0.0;
  std::size_t widest = 1, highest = 1;
  for (const Patch& patch : patches) {
    widest = std::max(widest, patch.column_end - patch.column);
    highest = std::max(highest, patch.row_end - patch.row);
  }
  const double aspect = level.field.grid().pitch_x / level.field.grid().pitch_y;
  for (std::size_t side = 1; side <= widest; side = side + std::max<std::size_t>(1, side / 2)) {
    const auto across =
        std::max<std::size_t>(1, static_cast<std::size_t>(std::llround(static_cast<double>(side) * aspect)));
    if (across > highest) break;
    const BlockScatter scatter = scatter_of(level, patches, window, side, across);
    if (scatter.blocks - scatter.plateaus < enough_freedom) break;
    largest = std::max(largest, scatter.variance * static_cast<double>(side * across));
  }
  return largest;
}

}  // namespace

Tilt rough_tilt(const HeightField& field, std::size_t columns_apart, std::size_t rows_apart) {
  constexpr std::size_t most = 200000;
  std::vector<double> along, across;
  const std::size_t every = std::max<std::size_t>(1, field.grid().size() / most);
  for (std::size_t i = 0; i < field.grid().size(); i += every) {
    const std::size_t column = i % field.columns(), row = i / field.columns();
    const auto here = static_cast<double>(field.at(column, row));
    if (std::isnan(here)) continue;
    if (column + columns_apart < field.columns()) {
      const auto there = static_cast<double>(field.at(column + columns_apart, row));
      if (!std::isnan(there)) along.push_back(there - here);
    }
    if (row + rows_apart < field.rows()) {
      const auto there = static_cast<double>(field.at(column, row + rows_apart));
      if (!std::isnan(there)) across.push_back(there - here);
    }
  }
  return {shorth(std::move(along)) / (static_cast<double>(columns_apart) * field.grid().pitch_x.um()),
          shorth(std::move(across)) / (static_cast<double>(rows_apart) * field.grid().pitch_y.um()), 0.0};
}

Levelled level_plateaus(const HeightField& field, const std::vector<Patch>& patches, std::size_t plateaus,
                        const Tilt& start) {
  Level level{field, start};
  std::vector<Window> window;
  std::vector<Moments> sums;
  for (int i = 0; i < 4; ++i) {
    window = windows(level, patches, plateaus);
    sums = moments(level, patches, window);
    const Tilt rest = tilt_within(sums);
    level.tilt.slope_x += rest.slope_x;
    level.tilt.slope_y += rest.slope_y;
  }
  window = windows(level, patches, plateaus);
  sums = moments(level, patches, window);
  const double variance = correlated_variance(level, patches, window);
  Levelled levelled{level.tilt, 0.0, {}};
  double square = 0.0, count = 0.0, lever = 0.0;
  for (const Moments& s : sums) {
    const double samples = std::max(1.0, s.count);
    levelled.plateaus.push_back(
        {s.z / samples, std::sqrt(variance / samples), s.x / samples, static_cast<std::size_t>(s.count), s.outliers});
    square += s.zz - s.z * s.z / samples;
    count += s.count;
    lever += s.xx - s.x * s.x / samples;
  }
  levelled.tilt.error_x = lever > 0.0 ? std::sqrt(variance / lever) : 0.0;
  levelled.roughness_um = std::sqrt(std::max(0.0, square) / std::max(1.0, count));
  return levelled;
}

}  // namespace mezzotint
