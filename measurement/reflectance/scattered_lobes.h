#pragma once

#include <vector>

#include "forward/optics/direction.h"
#include "measurement/reflectance/lobe_samples.h"
#include "measurement/reflectance/triangulation.h"

namespace mezzotint {

/// What leaves for one direction of the light, at directions in no particular order.
///
/// Frame    azimuthal equidistant plane: (θ cosΔφ, θ sinΔφ) in radians, Δφ from the plane of the light, so that
///          (θ_i, 0) looks back into the light.
/// Shape    values: point by point, channels together. Units: 1/sr.
struct ScatteredLobe {
  Angle theta_i;
  Triangulation plane;
  std::vector<float> values;
};

/// Lobes of an isotropic sample at some angles of incidence.
struct ScatteredLobes {
  bool symmetric = true;  ///< points lie in y ≥ 0; the other half is their mirror image
  std::vector<ScatteredLobe> lobes;
};

/// Linear in the triangle of samples around the direction; NaN outside of the samples and in gaps between them, and for
/// a light that is not at one of the angles.
[[nodiscard]] double evaluate(const ScatteredLobes& lobes, const Direction& to_light, const Direction& to_viewer,
                              const ChannelWeights& weights);

/// One row of a file: a light, a viewer in its plane, and the samples of all channels.
struct ScatteredSample {
  Angle theta_i;
  PlanePoint place;
  std::vector<float> values;
};

/// Rows in any order, as lobes: folded where all of them lie on one side of the plane of incidence; rows at one place
/// are averaged.
/// @throws InvalidInput for fewer than three directions for a light, or more than Triangulation::most_points.
[[nodiscard]] ScatteredLobes scattered_lobes(std::vector<ScatteredSample> samples);

}  // namespace mezzotint
