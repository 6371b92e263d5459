#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "forward/base/random.h"
#include "forward/surface/height_field.h"

namespace mezzotint::test {

/// A smooth random relief in closed form: cosines of random direction and phase, wavelengths within a band. Known at
/// every point, so that a measurement of it can be made without interpolating anything.
class CosineRelief {
public:
  CosineRelief(std::uint64_t seed, double shortest_um, double longest_um, double rms_um = 2.0, int count = 48) {
    const RandomStream random(seed, RandomPurpose::Test);
    for (int k = 0; k < count; ++k) {
      const auto u = random.uniform4(static_cast<std::uint64_t>(k));
      const double wave = 2.0 * std::numbers::pi * (1.0 / longest_um + u[0] * (1.0 / shortest_um - 1.0 / longest_um));
      const double direction = 2.0 * std::numbers::pi * u[1];
      waves_.push_back({wave * std::cos(direction), wave * std::sin(direction), 2.0 * std::numbers::pi * u[2]});
    }
    amplitude_um_ = rms_um * std::sqrt(2.0 / count);
  }

  [[nodiscard]] double height_um(double x_um, double y_um) const {
    double sum = 0.0;
    for (const Wave& wave : waves_) sum += std::cos(wave.kx * x_um + wave.ky * y_um + wave.phase);
    return amplitude_um_ * sum;
  }

  /// Samples on a grid; `turned` and shifted about the middle of `design` as Registration defines it.
  [[nodiscard]] HeightField on(const Grid& grid, const Grid& design, double shift_x_um = 0.0, double shift_y_um = 0.0,
                               double degrees = 0.0) const {
    const double cx = 0.5 * static_cast<double>(design.columns - 1) * design.pitch_x.um();
    const double cy = 0.5 * static_cast<double>(design.rows - 1) * design.pitch_y.um();
    const double c = std::cos(degrees * std::numbers::pi / 180.0);
    const double s = std::sin(degrees * std::numbers::pi / 180.0);
    HeightField field(grid, Continuation::Mirrored);
    for (std::size_t row = 0; row < grid.rows; ++row) {
      for (std::size_t column = 0; column < grid.columns; ++column) {
        const double x = static_cast<double>(column) * grid.pitch_x.um() - cx - shift_x_um;
        const double y = static_cast<double>(row) * grid.pitch_y.um() - cy - shift_y_um;
        field.at(column, row) = static_cast<float>(height_um(c * x + s * y + cx, -s * x + c * y + cy));
      }
    }
    return field;
  }
  [[nodiscard]] HeightField on(const Grid& grid) const { return on(grid, grid); }

private:
  struct Wave {
    double kx, ky, phase;
  };
  std::vector<Wave> waves_;
  double amplitude_um_ = 1.0;
};

inline Grid square_grid(std::size_t side, double pitch_um) {
  return {side, side, Length::from_um(pitch_um), Length::from_um(pitch_um)};
}

}  // namespace mezzotint::test
