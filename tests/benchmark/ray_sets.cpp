#include "tests/benchmark/ray_sets.h"

#include <optional>

#include <fmt/format.h>

#include "forward/scattering/incident_light.h"
#include "forward/scattering/interaction_batch.h"
#include "forward/tracing/beam_front.h"

namespace mezzotint::benchmark {

RaySet incident_rays(const PeriodicTile& tile, const HeightFieldTracer& tracer, double theta_deg, Start start,
                     std::uint32_t bits) {
  PathTracingOptions options;
  options.incidence = {Angle::from_degrees(theta_deg), Angle::from_degrees(30.0)};
  std::optional<BeamFront> front;
  if (start == Start::Front) front.emplace(tracer.pyramid(), -to_direction(options.incidence), tile.mean());
  const IncidentLight light(tile.frame(), options, front ? &*front : nullptr);
  const SampleStrata strata(bits, Placement::Strata, 1, 0, 0);
  RaySet set{fmt::format("{} {:.0f}°", start == Start::Front ? "incident" : "from top", theta_deg), {}};
  AimedRays aimed(rays_per_call);
  for (std::uint64_t first = 0; first < std::uint64_t{1} << bits; first += rays_per_call) {
    light.fill(strata, first, first, rays_per_call, aimed);
    set.calls.push_back(aimed.rays);
  }
  return set;
}

RaySet reflected_rays(const RaySet& rays, const HeightFieldTracer& tracer) {
  RaySet set{rays.name, {}};
  HitBatch hits(rays_per_call);
  InteractionBatch met(rays_per_call);
  for (const RayBatch& call : rays.calls) {
    tracer.closest_hits(call, call.size(), hits);
    interact_geometric(Mirror{}, {}, call, hits, call.size(), met);
    RayBatch next(call.size());
    std::size_t count = 0;
    for (std::size_t k = 0; k < call.size(); ++k) {
      if (hits.end[k] != RayEnd::Surface) continue;
      next.cell_x[count] = hits.cell_x[k];
      next.cell_y[count] = hits.cell_y[k];
      next.x[count] = hits.x[k];
      next.y[count] = hits.y[k];
      next.z[count] = hits.z[k];
      next.dx[count] = met.reflected_x[k];
      next.dy[count] = met.reflected_y[k];
      next.dz[count] = met.reflected_z[k];
      next.side[count] = call.side[k];
      next.left[count++] = hits.triangle[k];
    }
    next.resize(count);
    set.calls.push_back(next);
  }
  return set;
}

}  // namespace mezzotint::benchmark
