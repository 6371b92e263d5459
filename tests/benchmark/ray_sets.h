#pragma once

#include <string>
#include <vector>

#include "forward/scattering/path_tracing.h"
#include "forward/tracing/height_field_tracer.h"
#include "forward/tracing/ray_batch.h"

namespace mezzotint::benchmark {

/// So many rays are traced in one call, as in a walk.
inline constexpr std::size_t rays_per_call = 4096;

/// Rays in the order in which they are traced, cut into calls.
struct RaySet {
  std::string name;
  std::vector<RayBatch> calls;
  [[nodiscard]] std::size_t size() const {
    std::size_t sum = 0;
    for (const RayBatch& call : calls) sum += call.size();
    return sum;
  }
};

enum class Start { Top, Front };  ///< above the highest point, or at the beam's front

/// A beam at `theta_deg` through 2^bits strata in Morton order. Its azimuth is 30°: along no axis.
[[nodiscard]] RaySet incident_rays(const PeriodicTile& tile, const HeightFieldTracer& tracer, double theta_deg,
                                   Start start, std::uint32_t bits);

/// The rays of a set after a mirror reflection, in the same order.
[[nodiscard]] RaySet reflected_rays(const RaySet& rays, const HeightFieldTracer& tracer);

}  // namespace mezzotint::benchmark
