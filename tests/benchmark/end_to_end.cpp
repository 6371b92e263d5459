#include "tests/benchmark/end_to_end.h"

#include <string>
#include <vector>

#include <fmt/format.h>
#include <tbb/global_control.h>

#include "forward/scattering/path_walk.h"
#include "forward/tracing/beam_front.h"
#include "forward/tracing/height_field_tracer.h"
#include "tests/benchmark/measure.h"
#include "tests/benchmark/noise_relief.h"

namespace mezzotint::benchmark {

namespace {

// Passes calls on, and counts their time and their rays.
class TimedTracer final : public ReliefTracer {
public:
  explicit TimedTracer(const ReliefTracer& tracer) : tracer_(tracer) {}
  void closest_hits(const RayBatch& rays, std::size_t count, HitBatch& hits) const override {
    const double before = thread_seconds();
    tracer_.closest_hits(rays, count, hits);
    seconds += thread_seconds() - before;
    traced += count;
  }
  mutable double seconds = 0.0;
  mutable std::size_t traced = 0;

private:
  const ReliefTracer& tracer_;
};

struct Times {
  double tracer = 0.0, walk = 0.0;
  std::size_t rays = 0;
};

// The walks of a run, as PathTracer makes them.
Times walk_all(const PeriodicTile& tile, const HeightFieldTracer& tracer, const PathTracingOptions& options,
               std::uint32_t bits) {
  const TimedTracer timed(tracer);
  const BeamFront front(tracer.pyramid(), -to_direction(options.incidence), tile.mean());
  const IncidentLight light(tile.frame(), options, &front);
  const PathWalker walker(tile.frame(), &tile, timed, options);
  std::vector<BatchTally> tallies(options.batches, BatchTally(options.grid));
  WalkSpace space;
  constexpr std::uint64_t slice = std::uint64_t{1} << 14;
  const std::uint64_t rays = std::uint64_t{1} << bits;
  const double before = thread_seconds();
  for (std::uint64_t begin = 0; begin < rays; begin += slice) {
    for (std::uint32_t batch = 0; batch < options.batches; ++batch) {
      const SampleStrata strata(bits, options.placement, options.seed, 0, batch);
      for (std::uint64_t first = begin; first < begin + slice; first += rays_together)
        walker.walk(light, strata, first, batch * rays + first, rays_together, space, tallies[batch]);
      tallies[batch].close_slice();
    }
  }
  return {timed.seconds, thread_seconds() - before, timed.traced};
}

PathTracingOptions paths_of(double theta_deg, const Material& material, std::uint32_t bits) {
  PathTracingOptions run;
  run.incidence = {Angle::from_degrees(theta_deg), Angle::from_degrees(30.0)};
  run.material = material;
  run.control_variate = ControlVariate::Off;
  run.samples = std::uint64_t{run.batches} << bits;
  return run;
}

}  // namespace

nlohmann::json end_to_end(const RaceOptions& options) {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const HeightField field = noise_relief(options.size, options.gradient);
  const PeriodicTile tile(field);
  const HeightFieldTracer tracer(tile);
  PathTracer paths(field);
  const std::uint32_t bits = options.bits;  // a batch has the rays of the race
  fmt::print("\nEnd to end, {}² cells, 2^{} paths in 8 batches, one thread: tracer's calls ÷ all\n", options.size,
             bits + 3);
  fmt::print("{:18}{:>8}{:>14}{:>14}{:>10}{:>12}\n", "", "Mrays", "tracer Mr/s", "whole Mpath/s", "÷ walk", "÷ whole");
  nlohmann::json rows = nlohmann::json::array();
  for (const bool mirror : {true, false}) {
    for (const double theta : {0.0, 45.0, 80.0}) {
      const PathTracingOptions run = paths_of(theta, mirror ? Material{Mirror{}} : Material{Dielectric{1.5}}, bits);
      std::vector<double> of_walk, of_whole, rates, path_rates;
      std::size_t rays = 0;
      for (int repetition = 0; repetition < options.repetitions; ++repetition) {
        const Times times = walk_all(tile, tracer, run, bits);
        const double before = thread_seconds();
        (void)paths.trace(run);
        const double whole = thread_seconds() - before;
        rays = times.rays;
        of_walk.push_back(times.tracer / times.walk);
        of_whole.push_back(times.tracer / whole);
        rates.push_back(1e-6 * static_cast<double>(rays) / times.tracer);
        path_rates.push_back(1e-6 * static_cast<double>(run.samples) / whole);
      }
      const std::string name = fmt::format("{} {:.0f}°", mirror ? "mirror" : "dielectric", theta);
      fmt::print("{:18}{:>8.1f}{:>14.1f}{:>14.1f}{:>10.2f}{:>12.2f}\n", name, 1e-6 * static_cast<double>(rays),
                 median(rates), median(path_rates), median(of_walk), median(of_whole));
      std::fflush(stdout);
      rows.push_back({{"run", name},
                      {"rays", rays},
                      {"tracer_mrays_per_s", median(rates)},
                      {"mpaths_per_s", median(path_rates)},
                      {"tracer_over_walk", median(of_walk)},
                      {"tracer_over_whole", median(of_whole)}});
    }
  }
  return {{"cells", options.size}, {"rows", rows}};
}

}  // namespace mezzotint::benchmark
