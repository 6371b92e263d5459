#pragma once

#include <Eigen/Core>

#include "forward/base/units.h"

namespace mezzotint {

/// A unit vector that points away from the surface: toward the light or toward the viewer.
///
/// Frame    z is the normal of the macrosurface, x along a row of the relief, y from row to row.
using Direction = Eigen::Vector3d;

/// A direction by its angles: theta from +z, phi from +x counter-clockwise.
struct DirectionAngles {
  Angle theta;
  Angle phi;
};

[[nodiscard]] Direction to_direction(const DirectionAngles& angles);
[[nodiscard]] DirectionAngles to_angles(const Direction& direction);

}  // namespace mezzotint
