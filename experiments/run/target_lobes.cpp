#include "experiments/run/target_lobes.h"

#include "experiments/run/target_maps.h"
#include "forward/scattering/slope_splat.h"
#include "inverse/target/implied_slopes.h"
#include "measurement/formats/surface_file.h"

namespace mezzotint {

namespace {

LobeTarget lobes_of_maps(const TargetSpecification& wanted, const SimulationSpecification& simulation) {
  const TargetMaps maps = wanted_maps(wanted, simulation);
  return lobe_target(maps.grid, simulation.material, maps.incidences, maps.maps, maps.any_brightness);
}

}  // namespace

std::optional<LobeTarget> target_lobes(const Experiment& experiment, const RunFolder& folder, const Target& target) {
  const SimulationSpecification& simulation = experiment.simulation;
  if (target.kind == "anisotropy") return std::nullopt;
  if (target.kind != "scan") return lobes_of_maps(experiment.target, simulation);
  const DirectionGrid grid{simulation.resolution, simulation.resolution};
  const HeightField relief = read_gwy(folder / "target.gwy").field;
  std::vector<DirectionMap> maps;
  for (const auto& incidence : simulation.incidences)
    maps.push_back(slope_reflection_map(relief, simulation.material, incidence, grid));
  return lobe_target(grid, simulation.material, simulation.incidences, maps, false);
}

Target target_of_lobes(const TargetSpecification& wanted, const SimulationSpecification& simulation) {
  const LobeTarget lobes = lobes_of_maps(wanted, simulation);
  const SlopeAxes slopes = principal_axes(implied_slopes(lobes, lobes.maps).covariance);
  return {.kind = wanted.kind, .slopes = slopes, .rotation_matters = slopes.rms_major > 1.1 * slopes.rms_minor};
}

}  // namespace mezzotint
