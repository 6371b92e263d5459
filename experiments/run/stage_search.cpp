#include "experiments/configuration/pattern_table.h"
#include "experiments/run/run_files.h"
#include "experiments/run/stages.h"
#include "forward/base/file_output.h"
#include "measurement/formats/surface_file.h"

namespace mezzotint {

namespace {

// What the printed lobe should be, where the search is for the lobe and not for the slopes alone.
std::optional<LobeGoal> lobe_goal(const StageContext& context, const Target& target) {
  if (context.experiment.objective != SearchObjective::LobeCubeRoot) return std::nullopt;
  const SimulationSpecification& simulation = context.experiment.simulation;
  const DirectionGrid grid{simulation.resolution, simulation.resolution};
  if (target.kind == "scan") {
    return lobe_goal_of(read_gwy(context.folder / "target.gwy").field, simulation.material, simulation.incidences,
                        grid);
  }
  LobeGoal goal{grid, simulation.material, simulation.incidences, {}};
  for (const auto& incidence : simulation.incidences) {
    goal.maps.push_back(reflection_map(lobe_of(target.slopes), simulation.material, incidence, grid));
  }
  return goal;
}

DesignProblem problem_of(const StageContext& context, const Target& target) {
  const Experiment& experiment = context.experiment;
  return {.target = target,
          .pattern = experiment.pattern.pattern,
          .free = experiment.pattern.free,
          .printer = experiment.printer,
          .patch = experiment.patch,
          .search_draws = experiment.search_draws,
          .fresh_draws = experiment.fresh_draws,
          .search = experiment.search,
          .lobe = lobe_goal(context, target)};
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
