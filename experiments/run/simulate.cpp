#include "experiments/run/simulate.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace mezzotint {

namespace {

// Pilots draw from seeds that nobody else uses, so that a result's seed is the one that was asked for.
constexpr std::uint64_t pilot_seed_offset = std::uint64_t{1} << 60;
// The pilot's own uncertainty must not leave the result just short of what was asked for.
constexpr double safety = 1.15;

std::uint64_t samples_for(double pilot_error, const SimulationSpecification& simulation) {
  const double factor = std::pow(safety * pilot_error / simulation.tolerance, 2.0);
  const double wanted = std::max(1.0, factor) * static_cast<double>(simulation.least_samples);
  return static_cast<std::uint64_t>(std::min(wanted, static_cast<double>(simulation.most_samples)));
}

}  // namespace

double relative_error(const DirectionGrid& grid, const MapEstimate& map) {
  const auto areas = projected_solid_angles(grid);
  double noise = 0.0, power = 0.0;
  for (std::size_t bin = 0; bin < areas.size(); ++bin) {
    noise += areas[bin] * map.standard_error[bin] * map.standard_error[bin];
    power += areas[bin] * map.mean[bin] * map.mean[bin];
  }
  return power > 0.0 ? std::sqrt(noise / power) : 0.0;
}

Bsdf simulate(PathTracer& relief, const SimulationSpecification& simulation, const DirectionAngles& incidence,
              std::uint64_t seed, const Progress& progress) {
  PathTracingOptions options{.incidence = incidence,
                             .grid = {simulation.resolution, simulation.resolution},
                             .material = simulation.material,
                             .samples = std::min(simulation.least_samples, simulation.most_samples),
                             .seed = pilot_seed_offset + seed};
  Bsdf result = relief.trace(options);
  const double pilot_error = relative_error(options.grid, result.reflection);
  if (pilot_error > simulation.tolerance && options.samples < simulation.most_samples) {
    options.samples = samples_for(pilot_error, simulation);
    options.seed = seed;
    result = relief.trace(options, progress);
  }
  result.provenance["relative_standard_error"] = fmt::format("{:.6g}", relative_error(options.grid, result.reflection));
  return result;
}

}  // namespace mezzotint
