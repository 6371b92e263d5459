#include "experiments/run/simulate.h"

#include <fmt/format.h>

namespace mezzotint {

Bsdf simulate(PathTracer& relief, const SimulationSpecification& simulation, const DirectionAngles& incidence,
              std::uint64_t seed, const Progress& progress) {
  const PathTracingOptions options{.incidence = incidence,
                                   .grid = {simulation.resolution, simulation.resolution},
                                   .material = simulation.material,
                                   .samples = simulation.most_samples,
                                   .tolerance = simulation.tolerance,
                                   .seed = seed};
  Bsdf result = relief.trace(options, progress);
  result.provenance["relative_standard_error"] = fmt::format("{:.6g}", relative_error(options.grid, result.reflection));
  return result;
}

}  // namespace mezzotint
