#pragma once

#include <cstddef>
#include <vector>

#include "forward/pattern/noise_lattice.h"

/// Inside of forward/pattern.

namespace mezzotint {

/// A rectangle of the noise's lattice plane.
struct NoiseBounds {
  double x_low, x_high, y_low, y_high;
};

/// Sparse convolution noise on the plane z = 0 over a rectangle, for points in any order: drawn at 16 points a cell and
/// axis, and interpolated by a cubic (Catmull and Rom 1974) with continuous slopes; RMS error 3e-4 of the noise's unit,
/// 2e-3 at most.
///
/// Errors   InvalidInput for bounds outside of ±2^20 or that hold more than 2^17 cells.
class NoiseRaster {
public:
  NoiseRaster(const NoiseLattice& lattice, const NoiseBounds& bounds);

  /// noise(x, y, 0), or its integral; the point must lie within the bounds.
  [[nodiscard]] double operator()(double x, double y) const;

  /// From now on it holds the noise's integral along y, from an origin of its own for every x.
  void integrate_along_y();

private:
  double x_low_ = 0.0, y_low_ = 0.0;
  std::size_t columns_ = 0;
  std::vector<double> values_;
};

}  // namespace mezzotint
