#pragma once

#include <cstdint>
#include <functional>

#include <Eigen/Core>

#include "forward/base/units.h"

namespace mezzotint {

/// A point of a part's surface.
struct SurfacePoint {
  std::uint32_t triangle = 0;
  Eigen::Vector3d weights;   ///< of the triangle's corners, sum 1
  Eigen::Vector3d place_mm;  ///< on the triangle
};

/// How far the surface is moved outward at a point, in µm. It may keep what it has met; one for each thread.
using ReliefProbe = std::function<double(const SurfacePoint&)>;

/// What a surface is clothed with: a displacement along the outward normal.
struct SurfaceRelief {
  std::function<ReliefProbe()> make_probe;
  Length lowest, highest;  ///< the displacement lies within
};

}  // namespace mezzotint
