#include "forward/pattern/noise_raster.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "forward/base/error.h"
#include "forward/pattern/noise_scatter.h"

namespace mezzotint {

namespace {

constexpr double points_a_cell = 16.0;
constexpr double most_cells = 131072.0;

std::array<double, 4> catmull_rom(double t) {
  const double s = 1.0 - t;
  return {-0.5 * t * s * s, 1.0 + t * t * (1.5 * t - 2.5), 1.0 + s * s * (1.5 * s - 2.5), -0.5 * s * t * t};
}

}  // namespace

NoiseRaster::NoiseRaster(const NoiseLattice& lattice, const NoiseBounds& bounds) {
  const double width = bounds.x_high - bounds.x_low, depth = bounds.y_high - bounds.y_low;
  // Written so that NaN fails.
  require((width + 1.0) * (depth + 1.0) <= most_cells,
          "the patch, with the lines that begin outside of it, holds more than 2^17 noise cells; use a larger scale");
  // Points beyond the bounds for the cubic: one on the low side, two on the high side, and one for the integral's half.
  x_low_ = bounds.x_low - 2.0 / points_a_cell;
  y_low_ = bounds.y_low - 2.0 / points_a_cell;
  columns_ = static_cast<std::size_t>(width * points_a_cell) + 6;
  const std::size_t rows = static_cast<std::size_t>(depth * points_a_cell) + 6;
  std::vector<float> noise(columns_ * rows, 0.0F);
  const PatternMap map{.ux = 1.0 / points_a_cell, .vy = 1.0 / points_a_cell, .u0 = x_low_, .v0 = y_low_};
  add_sparse_noise(noise, {columns_, rows, Length::from_um(1.0), Length::from_um(1.0)}, map, lattice, 0.0, 1.0);
  values_.assign(noise.begin(), noise.end());
}

// By the midpoint rule: the sum up to a row is the integral up to half a row beyond it.
void NoiseRaster::integrate_along_y() {
  for (double& value : values_) value /= points_a_cell;
  for (std::size_t i = columns_; i < values_.size(); ++i) values_[i] += values_[i - columns_];
  y_low_ += 0.5 / points_a_cell;
}

double NoiseRaster::operator()(double x, double y) const {
  const double column = (x - x_low_) * points_a_cell, row = (y - y_low_) * points_a_cell;
  const auto left = static_cast<std::size_t>(column), low = static_cast<std::size_t>(row);
  const auto across = catmull_rom(column - static_cast<double>(left));
  const auto up = catmull_rom(row - static_cast<double>(low));
  const double* at = &values_[(low - 1) * columns_ + left - 1];
  double sum = 0.0;
  for (std::size_t k = 0; k < 4; ++k, at += columns_) {
    sum += up[k] * (across[0] * at[0] + across[1] * at[1] + across[2] * at[2] + across[3] * at[3]);
  }
  return sum;
}

}  // namespace mezzotint
