#include "forward/scattering/path_tracing.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "forward/base/error.h"
#include "forward/scattering/batch_tally.h"
#include "forward/scattering/incident_light.h"
#include "forward/scattering/path_walk.h"
#include "forward/scattering/relief_scene.h"

namespace mezzotint {

namespace {

// Between two looks at `progress` every batch in flight walks this many paths, some 10 ms.
constexpr std::uint64_t paths_per_slice = std::uint64_t{1} << 14;

void require_valid(const PathTracingOptions& options) {
  mezzotint::require_valid(options.grid);
  const double theta = options.incidence.theta.radians();
  require(theta >= 0.0 && theta < 0.5 * std::numbers::pi && std::isfinite(options.incidence.phi.radians()),
          "the light must come from above: theta from 0 up to, but not including, 90°");
  require(options.batches >= 4 && options.batches % 2 == 0 && options.batches <= 65536,
          "the number of batches must be even, from 4 to 65536");
  require(options.samples >= 1 && options.samples <= (std::uint64_t{1} << 36),
          "the number of samples must be from 1 to 2^36");
  require(options.max_bounces >= 1 && options.max_bounces <= 65536, "a path needs from 1 to 65536 interactions");
  if (const auto* dielectric = std::get_if<Dielectric>(&options.material)) {
    require(dielectric->eta >= 1.0001 && dielectric->eta <= 10.0,
            "the index of refraction of a dielectric must be from 1.0001 to 10");
  }
}

std::uint32_t strata_bits(const PathTracingOptions& options) {
  const std::uint64_t least = (options.samples + options.batches - 1) / options.batches;
  return static_cast<std::uint32_t>(std::bit_width(least - 1));
}

// How much of the result stands, while batches arrive in their order.
struct Statistics {
  explicit Statistics(const DirectionGrid& grid)
      : reflected(grid.size()), transmitted(grid.size()), energy(fate_count) {}

  void add(const BatchTally& tally) {
    reflected.add(tally.reflected);
    transmitted.add(tally.transmitted);
    energy.add(tally.total_energy);
    interactions += tally.interactions;
    normal_fallbacks += tally.normal_fallbacks;
    leaked += tally.leaked;
  }

  BatchStatistics reflected;
  BatchStatistics transmitted;
  BatchStatistics energy;
  std::uint64_t interactions = 0;
  std::uint64_t normal_fallbacks = 0;
  double leaked = 0.0;
};

// Enough batches at once to keep all threads busy, as long as their maps fit into memory. The order of sums
// does not depend on it.
std::uint32_t batches_at_once(const PathTracingOptions& options) {
  constexpr std::size_t memory = std::size_t{2} << 30;
  const std::size_t batch_bytes = 2 * sizeof(double) * options.grid.size();
  const std::size_t fit = std::max<std::size_t>(1, memory / batch_bytes);
  const auto threads = static_cast<std::size_t>(std::max(1, tbb::this_task_arena::max_concurrency()));
  return static_cast<std::uint32_t>(std::min({std::size_t{options.batches}, fit, 4 * threads}));
}

void walk_slice(const PathWalker& walker, const IncidentLight& light, std::uint32_t batch, std::uint64_t begin,
                BatchTally& tally) {
  const std::uint64_t end = std::min(begin + paths_per_slice, light.rays_per_batch());
  for (std::uint64_t stratum = begin; stratum < end; ++stratum) {
    walker.walk(light.ray(batch, stratum), light.ray_index(batch, stratum), tally);
  }
  tally.close_slice();
}

Statistics walk_all(const PathWalker& walker, const IncidentLight& light, const PathTracingOptions& options,
                    const Progress& progress) {
  Statistics statistics(options.grid);
  const std::uint32_t group = batches_at_once(options);
  for (std::uint32_t first = 0; first < options.batches; first += group) {
    const std::uint32_t count = std::min(group, options.batches - first);
    std::vector<BatchTally> tallies(count, BatchTally(options.grid));
    for (std::uint64_t begin = 0; begin < light.rays_per_batch(); begin += paths_per_slice) {
      tbb::parallel_for(std::uint32_t{0}, count,
                        [&](std::uint32_t k) { walk_slice(walker, light, first + k, begin, tallies[k]); });
      const double of_group = static_cast<double>(std::min(begin + paths_per_slice, light.rays_per_batch())) /
                              static_cast<double>(light.rays_per_batch());
      report(progress, "trace", (first + count * of_group) / options.batches);
    }
    for (const BatchTally& tally : tallies) statistics.add(tally);
  }
  return statistics;
}

// Tallies of weight to 1/sr: by the light that met the measured part, and the projected solid angle of the bin.
std::vector<double> map_scale(const DirectionGrid& grid, double light_that_met) {
  std::vector<double> scale = projected_solid_angles(grid);
  for (double& area : scale) area = area > 0.0 ? 1.0 / (light_that_met * area) : 0.0;
  return scale;
}

EnergyAudit audit(const BatchStatistics& energy, double rays_per_batch) {
  const std::vector<double> scale(fate_count, 1.0 / rays_per_batch);
  const MapEstimate shares = energy.estimate(scale);
  const auto share = [&](Fate fate) {
    const auto k = static_cast<std::size_t>(fate);
    return Estimate{shares.mean[k], shares.standard_error[k]};
  };
  return {share(Fate::Reflected), share(Fate::Transmitted), share(Fate::Absorbed), share(Fate::LeftSideways),
          share(Fate::CutOff)};
}

Provenance provenance(const PathTracingOptions& options, const Statistics& statistics, std::uint64_t samples) {
  const double fallbacks = static_cast<double>(statistics.normal_fallbacks) /
                           static_cast<double>(std::max<std::uint64_t>(1, statistics.interactions));
  return {{"model", "paths"},
          {"tracer", "embree"},
          {"estimator", options.estimator == Estimator::Flux ? "flux" : "slides"},
          {"material", to_string(options.material)},
          {"normals", options.normals == NormalKind::Geometric ? "geometric" : "interpolated"},
          {"samples", std::to_string(samples)},
          {"batches", std::to_string(options.batches)},
          {"seed", std::to_string(options.seed)},
          {"max_bounces", std::to_string(options.max_bounces)},
          {"incidence_spread", options.spread_incidence_over_bin ? "bin" : "none"},
          {"interactions_per_path",
           fmt::format("{:.6g}", static_cast<double>(statistics.interactions) / static_cast<double>(samples))},
          {"normal_fallback_share", fmt::format("{:.6g}", fallbacks)},
          {"leaked_share", fmt::format("{:.6g}", statistics.leaked / static_cast<double>(samples))}};
}

}  // namespace

struct PathTracer::Scene {
  explicit Scene(const HeightField& field) : tile(field), triangles(tile) {}
  PeriodicTile tile;
  ReliefScene triangles;
  bool has_normals = false;
};

PathTracer::PathTracer(const HeightField& field) : scene_(std::make_unique<Scene>(field)) {}
PathTracer::~PathTracer() = default;

Bsdf PathTracer::trace(const PathTracingOptions& options, const Progress& progress) {
  require_valid(options);
  if (options.normals == NormalKind::Interpolated && !scene_->has_normals) {
    scene_->tile.prepare_normals();
    scene_->has_normals = true;
  }
  const IncidentLight light(scene_->tile, options, strata_bits(options));
  const Statistics statistics =
      walk_all(PathWalker(scene_->tile, scene_->triangles, options), light, options, progress);

  Bsdf bsdf;
  bsdf.incidence = options.incidence;
  bsdf.grid = options.grid;
  const auto rays = static_cast<double>(light.rays_per_batch());
  bsdf.energy = audit(statistics.energy, rays);
  const double met = 1.0 - bsdf.energy.left_sideways.value;
  if (!(met > 0.0)) {
    throw MethodError("all light met mirrored copies before the measured patch; it is too small for this incidence");
  }
  const std::vector<double> scale = map_scale(options.grid, met * rays);
  bsdf.reflection = statistics.reflected.estimate(scale);
  bsdf.transmission = statistics.transmitted.estimate(scale);
  bsdf.provenance = provenance(options, statistics, options.batches * light.rays_per_batch());
  return bsdf;
}

Bsdf trace_bsdf(const HeightField& field, const PathTracingOptions& options, const Progress& progress) {
  require_valid(options);  // before the tree is built
  report(progress, "trace", 0.0, "building the tree of triangles");
  return PathTracer(field).trace(options, progress);
}

}  // namespace mezzotint
