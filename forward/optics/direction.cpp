#include "forward/optics/direction.h"

#include <cmath>

namespace mezzotint {

Direction to_direction(const DirectionAngles& angles) {
  const double sine = std::sin(angles.theta.radians());
  return {sine * std::cos(angles.phi.radians()), sine * std::sin(angles.phi.radians()),
          std::cos(angles.theta.radians())};
}

DirectionAngles to_angles(const Direction& direction) {
  // acos(z) would lose half of the digits near the normal.
  const double across = std::hypot(direction.x(), direction.y());
  return {Angle::from_radians(std::atan2(across, direction.z())),
          Angle::from_radians(std::atan2(direction.y(), direction.x()))};
}

}  // namespace mezzotint
