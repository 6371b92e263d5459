#pragma once

#include <vector>

#include "forward/optics/direction.h"
#include "measurement/reflectance/lobe_samples.h"

namespace mezzotint {

/// An isotropic BRDF as a table of half and difference angles, all of them.
///
/// Shape    channel R, G, B; half angle, difference angle, azimuth of the difference over half a turn (reciprocity
///          gives the other half). Half angles are spaced by the square root, fine about the mirrored ray.
/// Units    1/sr. Missing: NaN.
/// Source   Matusik, Pfister, Brand & McMillan 2003; Rusinkiewicz 1998 for the angles.
struct HalfAngleTable {
  static constexpr std::size_t half_angles = 90, difference_angles = 90, azimuths = 180;
  static constexpr std::size_t channel_size = half_angles * difference_angles * azimuths;
  std::vector<float> values;
};

/// The bin that a pair of directions falls in, as the authors look it up: not interpolated.
[[nodiscard]] double evaluate(const HalfAngleTable& table, const Direction& to_light, const Direction& to_viewer,
                              const ChannelWeights& weights);

/// Half angle, difference angle, and azimuth of the difference, in radians.
struct HalfDifference {
  double theta_half, theta_difference, phi_difference;
};
[[nodiscard]] HalfDifference half_difference(const Direction& to_light, const Direction& to_viewer);

}  // namespace mezzotint
