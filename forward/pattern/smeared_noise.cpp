#include <algorithm>
#include <array>
#include <cmath>

#include "forward/pattern/line_integral_convolution.h"
#include "forward/pattern/sparse_noise.h"

namespace mezzotint {

namespace {

double square(double value) { return value * value; }

// (1 − 4r²)³ within r < ½.
double kernel(double r_square) {
  const double falloff = std::max(0.0, 1.0 - 4.0 * r_square);
  return falloff * falloff * falloff;
}

// Autocorrelation of the noise at a distance, stationary form, scaled to its variance on the lattice plane: that of
// the kernel in space, in cylinder coordinates about the line through both centres.
class Autocorrelation {
public:
  static constexpr int count = 257;  // distances in [0, 1], where it ends

  Autocorrelation() {
    constexpr int steps = 160;
    for (int i = 0; i < count; ++i) {
      const double distance = static_cast<double>(i) / (count - 1);
      double sum = 0.0;
      for (int a = 0; a < steps; ++a) {
        const double x = (a + 0.5) / steps - 0.5;  // along the line, from the middle between both centres
        for (int b = 0; b < steps / 2; ++b) {
          const double radius = (b + 0.5) / steps;
          sum += radius * kernel(square(x - distance / 2.0) + square(radius)) *
                 kernel(square(x + distance / 2.0) + square(radius));
        }
      }
      values_.at(static_cast<std::size_t>(i)) = sum;
    }
    const double scale = noise_variance_at_z0 / values_[0];
    for (double& value : values_) value *= scale;
  }

  [[nodiscard]] double value(double distance) const {
    const double place = std::abs(distance) * (count - 1);
    if (place >= count - 1) return 0.0;
    const auto low = static_cast<std::size_t>(place);
    const double rest = place - static_cast<double>(low);
    return (1.0 - rest) * values_[low] + rest * values_[low + 1];
  }
  // −R'(t)/t: the mean square slope across the line, of points a distance t along it.
  [[nodiscard]] double curvature(double distance) const {
    constexpr double half = 1.0 / 128.0;
    const double t = std::max(std::abs(distance), half);
    return (value(t - half) - value(t + half)) / (2.0 * half * t);
  }

private:
  std::array<double, count> values_{};
};

}  // namespace

LineSlopes smeared_noise(double length) {
  static const Autocorrelation noise;
  // The smeared noise correlates as the noise convolved with a triangle of the kernel's length.
  constexpr int steps = 2000;
  const double reach = std::min(length, 1.0);
  double variance = 0.0, across = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double t = (i + 0.5) * reach / steps;
    const double weight = 2.0 * (length - t) / (length * length) * reach / steps;
    variance += weight * noise.value(t);
    across += weight * noise.curvature(t);
  }
  const double along = 2.0 * (noise.value(0.0) - noise.value(length)) / (length * length);
  const double gain = noise_variance_at_z0 / variance;
  return {gain * across, gain * along, std::sqrt(gain)};
}

}  // namespace mezzotint
