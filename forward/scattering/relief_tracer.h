#pragma once

#include <cstdint>
#include <limits>

#include "forward/optics/direction.h"

namespace mezzotint {

/// Which side of the surface a ray travels on: it can only meet faces that look at it.
enum class Side : std::uint8_t { Outside, Inside };

inline constexpr std::uint32_t no_triangle = std::numeric_limits<std::uint32_t>::max();

/// Frame and units: those of PeriodicTile. `direction` is the way the ray travels.
struct Ray {
  Eigen::Vector3d origin;
  Direction direction;
  Side side = Side::Outside;
  std::uint32_t left_triangle = no_triangle;  ///< the one that it has just left; a plane is not met twice
};

struct SurfaceHit {
  std::uint32_t triangle = no_triangle;
  double u = 0.0;  ///< weights of the triangle's second and third corner
  double v = 0.0;
  Eigen::Vector3d position;  ///< on the triangle, in the tile
  double distance = 0.0;     ///< from the ray's origin, through as many tiles as it took
};

/// Where a ray ends.
enum class RayEnd : std::uint8_t {
  Surface,
  Above,  ///< left upwards, above the highest point
  Below,  ///< left downwards, below the lowest point
  Lost    ///< found no end within the tiles that a ray may cross
};

/// What an estimator asks of a tracer. Called by many threads at once.
class ReliefTracer {
public:
  virtual ~ReliefTracer() = default;
  /// The first triangle in front of the ray that looks at it; `hit` is set where the answer is Surface.
  [[nodiscard]] virtual RayEnd closest_hit(const Ray& ray, SurfaceHit& hit) const = 0;
};

}  // namespace mezzotint
