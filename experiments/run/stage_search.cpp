#include "experiments/configuration/pattern_table.h"
#include "experiments/run/design_file.h"
#include "experiments/run/run_experiment.h"
#include "experiments/run/run_files.h"
#include "experiments/run/stages.h"
#include "forward/base/file_output.h"
#include "forward/scattering/slope_splat.h"
#include "measurement/formats/surface_file.h"

namespace mezzotint {

namespace {

// The lobes to show, or to compare with where slopes are what is wanted.
std::optional<LobeTarget> lobe_target_of(const StageContext& context, const Target& target) {
  if (target.kind == "anisotropy") return std::nullopt;
  const SimulationSpecification& simulation = context.experiment.simulation;
  const DirectionGrid grid{simulation.resolution, simulation.resolution};
  std::vector<DirectionMap> maps;
  std::optional<HeightField> relief;
  if (target.kind == "scan") relief = read_gwy(context.folder / "target.gwy").field;
  for (const auto& incidence : simulation.incidences) {
    maps.push_back(relief ? slope_reflection_map(*relief, simulation.material, incidence, grid)
                          : reflection_map(lobe_of(target.slopes), simulation.material, incidence, grid));
  }
  return lobe_target(grid, simulation.material, simulation.incidences, maps, false);
}

DesignProblem problem_of(const StageContext& context, const Target& target) {
  const Experiment& experiment = context.experiment;
  return {.target = target,
          .pattern = experiment.pattern.pattern,
          .free = experiment.pattern.free,
          .printer = experiment.printer,
          .patch = experiment.patch,
          .search_draws = experiment.search.draws,
          .fresh_draws = experiment.search.fresh_draws,
          .search = experiment.search.minimize,
          .objective = experiment.search.objective,
          .lobes = lobe_target_of(context, target),
          .by_light = is_by_light(experiment),
          .log = context.folder / "evaluations.jsonl",
          .log_digest = experiment_digest(experiment)};
}

Grid patch_grid(const Experiment& experiment) {
  const Length pitch = experiment.printer.pixel_pitch;
  return {experiment.patch.pixels, experiment.patch.pixels, pitch, pitch};
}

}  // namespace

std::vector<std::string> run_search(const StageContext& context) {
  const Target target = target_from_json(read_json(context.folder / "target.json"));
  const Design design = find_design(problem_of(context, target), context.progress);
  write_json(to_json(design), context.folder / "design.json");
  const Pattern drawn = draw_instance(design.pattern, design.print_seed).pattern;
  write_file(context.folder / "pattern.toml",
             pattern_file_text({drawn, patch_grid(context.experiment)},
                               "The design of \"" + context.experiment.title +
                                   "\": mezzotint synthesize pattern.toml -o relief.gwy"));
  return {"design.json", "pattern.toml"};
}

}  // namespace mezzotint
