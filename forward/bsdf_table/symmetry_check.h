#pragma once

#include <algorithm>
#include <cstddef>

#include "forward/bsdf_table/build_bsdf_table.h"

namespace mezzotint {

/// Whether the sample has the symmetry that its table was told: light from beyond the azimuths that were computed,
/// against what the symmetry makes of the table there. Reciprocity cannot tell: of gratings, whose lobes are lines
/// thinner than a bin, it is as bad where the symmetry holds (rms 1.2 at 32 × 32 bins) as where it does not (1.4).
///
/// How       From the middle ring, the middle azimuth: half a turn on (Point), mirrored (Mirror), each in turn
///           (PointAndMirror), 52° on (Isotropic: a period of no lattice). Both maps are blurred by a Gaussian of 0.15
///           of the disc's radius, since an image falls between the bins.
/// Units     relative to the blurred map, L2, without noise; 0 for SymmetryKind::None, which asks nothing.
struct SymmetryCheck {
  double difference = 0.0;  ///< the larger one
  double by_bins = 0.0;     ///< what a lobe on the border of two bins makes of it by falling to the other side
  std::size_t asked = 0;    ///< directions that were computed for it
  /// Beyond both the bins' doing and `tolerance`, that of the table between its directions. Half of the norm is never
  /// harmless: gratings and stretched noise that are called isotropic come to 0.7 and more.
  [[nodiscard]] bool is_doubtful(double tolerance) const {
    return difference > std::min(3.0 * tolerance, 0.5) && difference > 1.5 * by_bins;
  }
};
/// @throws what `compute` throws.
[[nodiscard]] SymmetryCheck check_symmetry(const BsdfTable& table, const ComputeBsdf& compute);

}  // namespace mezzotint
