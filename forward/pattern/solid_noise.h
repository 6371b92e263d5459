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

private:
  [[nodiscard]] const SolidCell& cell(std::int64_t x, std::int64_t y, std::int64_t z);

  NoiseLattice lattice_;
  std::vector<SolidCell> cells_;
};

/// A noise-like pattern in space: the plane's noise, fBm or turbulence carved out of a block, as on the slides.
///
/// Frame    x, y, z in µm. Its grains are round: `stretch` and `direction` belong to a plane and are not used.
/// Units    gray, height divided by the pattern's height, cut to [0, 1] as in the plane. On z = 0 it is the plane's.
class SolidPattern {
public:
  explicit SolidPattern(const Noise& noise);
  explicit SolidPattern(const FractionalBrownianMotion& motion);
  explicit SolidPattern(const Turbulence& turbulence);
  [[nodiscard]] double gray(double x_um, double y_um, double z_um);

private:
  SolidPattern(const OctaveSum& octaves, Length scale, CellHash hash);
  OctaveSum sum_;
  double per_um_;
  std::vector<SolidNoise> noises_;
};

}  // namespace mezzotint
