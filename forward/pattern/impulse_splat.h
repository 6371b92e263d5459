#pragma once

#include <cstddef>

#include "forward/pattern/noise_lattice.h"

/// Inside of forward/pattern.

namespace mezzotint {

/// Impulses of some cells that reach a plane, as seen from the rows of samples in it.
struct PlaneImpulses {
  static constexpr std::size_t room = 2 * CellImpulses::room;

  std::size_t count = 0;
  alignas(64) std::array<double, room> column, row;  ///< of the impulse, in samples
  alignas(64) std::array<double, room> headroom;     ///< 1 − 4 (z_j − z)²
  alignas(64) std::array<double, room> weight;
};

/// A square grid of samples, seen from the noise: with t = columns and s = rows from an impulse, the square distance is
/// (t − lean·s)²·fall/4 + s²·row_fall/4.
struct SampleRows {
  double lean = 0.0;
  double fall = 0.0, row_fall = 0.0;
  std::size_t columns = 0, rows = 0;
  std::size_t stride = 0;  ///< at least columns + widest_vector
};
inline constexpr std::size_t widest_vector = 16;

/// Sums a sample, each `stride` a row. With t = columns and s = rows from an impulse and f = headroom − 4 |p − p_j|²:
struct SplatSums {
  float* values;             ///< Σ weight·f³
  float* columns = nullptr;  ///< Σ weight·f²·t; null, like `rows`, where no gradient is wanted
  float* rows = nullptr;     ///< Σ weight·f²·s
};

/// Adds to the samples within the reach of each impulse (impulse_splat.cpp). The values have the same bits with a
/// gradient and without.
void splat_impulses(const PlaneImpulses& impulses, const SampleRows& rows, const SplatSums& sums);

}  // namespace mezzotint
