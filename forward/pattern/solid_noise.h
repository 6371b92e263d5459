#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "forward/pattern/noise_lattice.h"
#include "forward/pattern/octave_sum.h"
#include "forward/pattern/pattern_kinds.h"

namespace mezzotint {

/// The impulses of a cell, for vectors of floats. Inside of forward/pattern.
struct SolidCell {
  std::int64_t x = 0, y = 0, z = 0;
  bool filled = false;
  alignas(64) std::array<float, CellImpulses::room> at_x, at_y, at_z, weight;
};
/// A cell, and where a point stands in it.
struct SolidCorner {
  const SolidCell* cell;
  float x, y, z;
};

/// Sparse convolution noise in space, of unit lattice and unit amplitude, at points that come near one another: the
/// cells that were met last are kept. Not for several threads at once: each has its own.
///
/// Accuracy 2e-6 of `sparse_noise` (float, relative to the cell). Valid as `sparse_noise`.
class SolidNoise {
public:
  SolidNoise(std::uint64_t seed, CellHash hash);
  [[nodiscard]] double operator()(double x, double y, double z);

  /// The same with impulses drawn out along a unit vector, `stretch` times as long as wide, and of the same deviation.
  /// The vector may change from point to point: only what lies around a point counts, so the noise follows it.
  [[nodiscard]] double stretched(const std::array<double, 3>& at, const std::array<double, 3>& along, double stretch);

  /// The mean along a line of that length about a point, in the deviation of the noise that is not smeared.
  [[nodiscard]] double smeared(const std::array<double, 3>& at, const std::array<double, 3>& along, double length);

private:
  // A line about a point, and how far around it impulses count: along each axis.
  struct Line {
    std::array<double, 3> at, along, reach;
    double half;
  };
  template <class Sum>
  double sum_near_line(const Line& line, const Sum& sum_of);
  [[nodiscard]] const SolidCell& cell(std::int64_t x, std::int64_t y, std::int64_t z);

  NoiseLattice lattice_;
  std::vector<SolidCell> cells_;
  // The length that `amplitude_` belongs to.
  double length_ = -1.0, amplitude_ = 1.0;
};

/// A noise-like pattern in space: the plane's noise, fBm or turbulence carved out of a block, as on the slides.
///
/// Frame    x, y, z in µm. The pattern's own `stretch` and `direction` belong to a plane and are not used.
/// Units    gray, height divided by the pattern's height, cut to [0, 1] as in the plane. On z = 0 it is the plane's.
class SolidPattern {
public:
  explicit SolidPattern(const Noise& noise);
  explicit SolidPattern(const FractionalBrownianMotion& motion);
  explicit SolidPattern(const Turbulence& turbulence);
  [[nodiscard]] double gray(double x_um, double y_um, double z_um);
  /// With grains drawn out along a unit vector.
  [[nodiscard]] double gray_along(const std::array<double, 3>& at_um, const std::array<double, 3>& along,
                                  double stretch);

private:
  SolidPattern(const OctaveSum& octaves, Length scale, CellHash hash);
  template <class Value>
  double sum_of(const Value& value);
  OctaveSum sum_;
  double per_um_;
  std::vector<SolidNoise> noises_;
};

}  // namespace mezzotint
