#include "forward/surface/relief_warnings.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

namespace mezzotint {

namespace {

constexpr std::size_t rows_looked_at = 64;
constexpr double least_kept_by_two_samples = 0.55;
constexpr double largest_slope_error = 0.01;  // of the RMS gradient
constexpr double fewest_features = 16.0;

// Mean and mean square, about a value that keeps the digits.
class Moments {
public:
  void add(double value) {
    if (std::isnan(value)) return;
    count_ += 1.0;
    const double off = value - mean_;
    mean_ += off / count_;
    squares_ += off * (value - mean_);
  }
  [[nodiscard]] double variance() const { return count_ > 0.0 ? squares_ / count_ : 0.0; }

private:
  double count_ = 0.0, mean_ = 0.0, squares_ = 0.0;
};

struct SlopeScales {
  double over_one = 0.0, over_two = 0.0;  ///< variances of the slopes, both axes together
  double height_variance_um2 = 0.0;
  double largest_um = 0.0;
};

// A later sample along an axis: the wrapped one, or none (NaN).
double ahead(const HeightField& field, std::size_t column, std::size_t row) {
  if (!field.periodic() && (column >= field.columns() || row >= field.rows()))
    return std::numeric_limits<double>::quiet_NaN();
  return double{field.at(column % field.columns(), row % field.rows())};
}

SlopeScales measure(const HeightField& field) {
  const double per_x = 1.0 / field.grid().pitch_x.um(), per_y = 1.0 / field.grid().pitch_y.um();
  Moments x1, x2, y1, y2, heights;
  SlopeScales scales;
  const std::size_t step = std::max<std::size_t>(1, field.rows() / rows_looked_at);
  for (std::size_t row = 0; row < field.rows(); row += step) {
    for (std::size_t column = 0; column < field.columns(); ++column) {
      const double z = double{field.at(column, row)};
      heights.add(z);
      if (std::abs(z) > scales.largest_um) scales.largest_um = std::abs(z);
      x1.add((ahead(field, column + 1, row) - z) * per_x);
      x2.add((ahead(field, column + 2, row) - z) * per_x * 0.5);
      y1.add((ahead(field, column, row + 1) - z) * per_y);
      y2.add((ahead(field, column, row + 2) - z) * per_y * 0.5);
    }
  }
  scales.over_one = x1.variance() + y1.variance();
  scales.over_two = x2.variance() + y2.variance();
  scales.height_variance_um2 = heights.variance();
  return scales;
}

// Two rounded heights make a slope: each is off by up to half a step.
double slope_error_of_rounding(const HeightField& field, double largest_um) {
  const auto height = static_cast<float>(largest_um);
  const double step = double{std::nextafter(height, std::numeric_limits<float>::infinity())} - double{height};
  return step / std::sqrt(6.0) * std::hypot(1.0 / field.grid().pitch_x.um(), 1.0 / field.grid().pitch_y.um());
}

}  // namespace

std::vector<std::string> relief_warnings(const HeightField& field) {
  std::vector<std::string> warnings;
  const SlopeScales scales = measure(field);
  const double gradient = std::sqrt(scales.over_one);
  if (!(gradient > 0.0)) return warnings;
  const double kept = scales.over_two / scales.over_one;
  if (kept < least_kept_by_two_samples) {
    warnings.push_back(
        fmt::format("the relief changes from sample to sample (over two samples its slopes keep {:.0f} % of their "
                    "variance): features or steps are fewer than four samples across, so that the result is that of "
                    "the facets and not of a surface; sample it more finely",
                    100.0 * kept));
  }
  const double error = slope_error_of_rounding(field, scales.largest_um);
  if (error > largest_slope_error * gradient) {
    warnings.push_back(fmt::format(
        "heights up to {:.3g} µm are rounded so coarsely in single precision that slopes are off by {:.2g}, "
        "where the RMS gradient is {:.2g}; subtract the offset in double precision before they are stored",
        scales.largest_um, error, gradient));
  }
  const double feature_um = 2.0 * std::numbers::pi * std::sqrt(scales.height_variance_um2) / gradient;
  const double area = field.grid().pitch_x.um() * static_cast<double>(field.columns()) * field.grid().pitch_y.um() *
                      static_cast<double>(field.rows());
  if (!field.periodic() && area < fewest_features * feature_um * feature_um) {
    warnings.push_back(
        fmt::format("the patch holds some {:.2g} features of about {:.2g} µm: another patch of the same texture may "
                    "differ by more than the stated errors, which are those of this patch alone; use a larger one",
                    area / (feature_um * feature_um), feature_um));
  }
  return warnings;
}

}  // namespace mezzotint
