#pragma once

#include "forward/optics/direction_map.h"
#include "measurement/reflectance/measured_reflectance.h"

namespace mezzotint {

/// A measured lobe as a direction map.
struct ReflectanceMap {
  DirectionMap map;                 ///< the mean over what was measured of pixel ∩ disc; 0 where nothing was
  DirectionMap measured;            ///< share of pixel ∩ disc that was measured
  double not_measured_share = 0.0;  ///< of the whole disc, by projected solid angle
  double albedo = 0.0;              ///< Σ map · area · measured: what was measured of the reflected light
};

/// @param samples  points a bin and axis, see average_over_bins; the error of a bin falls as 1/samples² where the
///                 interpolated lobe is smooth, and as 1/samples at the edge of what was measured.
/// @throws InvalidInput for a light that was not measured, with those that were; for a bad grid.
[[nodiscard]] ReflectanceMap reflectance_map(const MeasuredReflectance& measured, const DirectionAngles& to_light,
                                             const ChannelChoice& channel, const DirectionGrid& grid,
                                             std::size_t samples = 8);

}  // namespace mezzotint
