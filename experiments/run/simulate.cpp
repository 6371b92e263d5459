#include "experiments/run/simulate.h"

#include <fmt/format.h>

#include "forward/ladder/ladder.h"

namespace mezzotint {

Bsdf simulate(const HeightField& field, PathTracer& relief, const SimulationSpecification& simulation,
              const DirectionAngles& incidence, std::uint64_t seed, const Progress& progress) {
  const PathTracingOptions options{.incidence = incidence,
                                   .grid = {simulation.resolution, simulation.resolution},
                                   .material = simulation.material,
                                   .samples = simulation.most_samples,
                                   .tolerance = simulation.tolerance,
                                   .seed = seed};
  const LadderOptions ladder{.incidence = incidence,
                             .grid = options.grid,
                             .material = simulation.material,
                             .tolerance = simulation.tolerance,
                             .wavelength = simulation.wavelength,
                             .most_samples = simulation.most_samples,
                             .seed = seed};
  Bsdf result =
      simulation.model == "auto" ? simulate_auto(field, relief, ladder, progress) : relief.trace(options, progress);
  result.provenance["relative_standard_error"] = fmt::format("{:.6g}", relative_error(options.grid, result.reflection));
  return result;
}

}  // namespace mezzotint
