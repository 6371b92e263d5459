#include "fabrication/appearance/solid_relief.h"

#include <memory>
#include <variant>

#include "forward/base/error.h"
#include "forward/pattern/solid_noise.h"

namespace mezzotint {

namespace {

template <class Kind>
concept NoiseLike = std::constructible_from<SolidPattern, const Kind&>;

template <class Kind>
SurfaceRelief relief_of(const Kind& kind) {
  if constexpr (NoiseLike<Kind>) {
    require(kind.stretch == 1.0,
            "solid noise has round grains: leave `stretch` out, or give the pattern a direction on the surface");
    const double height_um = kind.height.um();
    return {[kind, height_um]() -> ReliefProbe {
              auto pattern = std::make_shared<SolidPattern>(kind);
              return [pattern, height_um](const SurfacePoint& point) {
                const Eigen::Vector3d um = 1e3 * point.place_mm;
                return height_um * pattern->gray(um.x(), um.y(), um.z());
              };
            },
            Length{}, kind.height};
  } else {
    throw InvalidInput("solid patterns are noise, fbm and turbulence; this one needs a direction on the surface");
  }
}

}  // namespace

SurfaceRelief solid_relief(const Pattern& pattern) {
  require_valid(pattern);
  return std::visit([](const auto& kind) { return relief_of(kind); }, pattern);
}

}  // namespace mezzotint
