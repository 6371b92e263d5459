#pragma once

#include <vector>

#include "forward/optics/direction.h"
#include "measurement/reflectance/lobe_samples.h"

namespace mezzotint {

/// What leaves for one direction of the light, on a grid of two angles about an axis.
///
/// Shape    values: channel by channel, azimuth by azimuth, along the radial angles.
/// Units    radians, increasing; 1/sr. Missing: NaN.
struct PolarLobe {
  DirectionAngles incidence;
  std::vector<double> azimuth_rad, radial_rad;
  std::vector<float> values;
};

/// Lobes of the text formats of optical design.
///
/// Frame    `Normal`: the radial angle runs from the normal, the azimuth counter-clockwise from the plane of the
///          mirrored ray, so that (θ_i, 0) is the mirrored ray. `Mirrored`: the radial angle runs from the mirrored
///          ray, the azimuth about it, counter-clockwise from the direction of the normal.
/// Source   Radiant Zemax, BSDF Data Interchange file format.
struct PolarLobes {
  enum class Axis { Normal, Mirrored };
  Axis axis = Axis::Normal;
  bool symmetric = true;         ///< azimuths cover half a turn; the other half is their mirror image
  bool any_azimuth = true;       ///< one plane of incidence stands for all
  bool between = false;          ///< linear between incidences, about the mirrored ray of each
  std::vector<PolarLobe> lobes;  ///< θ increasing where `between`
};

/// Bilinear in both angles; NaN beyond the grid, and where one of the four samples is missing.
[[nodiscard]] double evaluate(const PolarLobes& lobes, const Direction& to_light, const Direction& to_viewer,
                              const ChannelWeights& weights);

}  // namespace mezzotint
