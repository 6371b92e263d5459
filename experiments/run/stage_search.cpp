#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "experiments/configuration/pattern_table.h"
#include "experiments/run/design_answer.h"
#include "experiments/run/design_file.h"
#include "experiments/run/run_experiment.h"
#include "experiments/run/run_files.h"
#include "experiments/run/search_free_form.h"
#include "experiments/run/stages.h"
#include "experiments/run/target_lobes.h"
#include "experiments/run/target_maps.h"
#include "forward/base/file_output.h"
#include "measurement/formats/surface_file.h"

namespace mezzotint {

namespace {

// A scan is one draw of its own size.
double draws_of_target(const StageContext& context, const Target& target) {
  if (target.kind != "scan") return HUGE_VAL;
  const Grid scan = read_gwy(context.folder / "target.gwy").field.grid();
  const PatchOptions& patch = context.experiment.patch;
  const double side = static_cast<double>(patch.pixels) * context.experiment.printer.pixel_pitch.um();
  return static_cast<double>(scan.size()) * scan.pitch_x.um() * scan.pitch_y.um() / (side * side);
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
          .lobes = target_lobes(experiment, context.folder, target),
          .by_light = is_by_light(experiment),
          .traced = experiment.search.traced,
          .target_draws = draws_of_target(context, target),
          .log = context.folder / "evaluations.jsonl",
          .log_digest = experiment_digest(experiment)};
}

Grid patch_grid(const Experiment& experiment) {
  const Length pitch = experiment.printer.pixel_pitch;
  return {experiment.patch.pixels, experiment.patch.pixels, pitch, pitch};
}

GrayImage gray_of(const DesignProblem& problem, const Design& design, std::uint64_t seed) {
  const HeightField heights = pixel_heights(draw_instance(design.pattern, seed), problem.printer, problem.patch.pixels);
  return expose(heights, problem.printer).image;
}

// An anisotropy names no lobe: its prediction stands beside the Beckmann lobe that it comes to, at the direction found.
LobeTarget shown_goal(const Experiment& experiment, const DesignProblem& problem, const Design& design) {
  if (problem.lobes) return *problem.lobes;
  SlopeAxes slopes = problem.target.slopes;
  slopes.rotation = design.on_fresh_draws.axes.rotation;
  const TargetMaps maps = wanted_maps({.kind = "beckmann", .wanted = lobe_of(slopes)}, experiment.simulation);
  return lobe_target(maps.grid, experiment.simulation.material, maps.incidences, maps.maps, false);
}

Verification traced_prediction(const DesignProblem& problem, const Design& design, const LobeTarget& goal,
                               const Progress& progress) {
  if (design.traced) return *design.traced;
  VerificationOptions options{.samples = 1U << 19};
  options.draw.subsamples = std::max(options.draw.subsamples, problem.patch.subsamples);
  options.draw.wavelength = problem.patch.wavelength;
  for (std::uint64_t i = 0; i < 4; ++i) options.seeds.push_back(design.fresh_seeds.front() + i);
  return verify_design([&](std::uint64_t seed) { return gray_of(problem, design, seed); }, problem.printer, goal,
                       options, progress);
}

void warn_of_layer(Design& design, const nlohmann::ordered_json& gray) {
  const auto used = gray.at("levels_used").get<std::size_t>();
  if (used < least_gray_levels) {
    design.warnings.push_back(
        fmt::format("the gray layer uses {} levels; below {} its steps show in the slopes", used, least_gray_levels));
  }
}

nlohmann::ordered_json answer_to_json(const StageContext& context, const DesignProblem& problem, Design& design,
                                      const nlohmann::ordered_json& gray) {
  warn_of_layer(design, gray);
  nlohmann::ordered_json json = to_json(design);
  json["figures"] = figures_to_json(design);
  json["gamut"] = read_json(context.folder / "gamut.json");
  json["gray"] = gray;
  json["shortest_length_px"] = shortest_length_px(design.pattern, problem.printer);
  const AxisSwap swap = axis_swap(design);
  json["quarter_turn"] = {{"direction_is_free", swap.is_free}, {"tried", swap.was_tried}, {"worse_by", nullptr}};
  if (swap.was_tried) json["quarter_turn"]["worse_by"] = swap.worse_by;
  json["blur"] = to_json(problem.printer, blur_sensitivity(problem, design));
  return json;
}

std::vector<std::string> search_pattern_design(const StageContext& context, const Target& target) {
  const DesignProblem problem = problem_of(context, target);
  Design design = find_design(problem, context.progress);
  if (is_lobe_alone(context.experiment.target)) {
    const TargetMaps maps = wanted_maps(context.experiment.target, context.experiment.simulation);
    design.warnings.insert(design.warnings.begin(), maps.notes.begin(), maps.notes.end());
  }
  const LobeTarget goal = shown_goal(context.experiment, problem, design);
  std::vector<std::string> outputs =
      write_lobes(context, goal, traced_prediction(problem, design, goal, context.progress));
  const GrayImage gray = quantize(gray_of(problem, design, design.print_seed), problem.printer);
  const PrintedTexture texture(problem.printer, problem.patch, {design.print_seed});
  const auto layer = write_layer(context, gray, texture.print(design.pattern, 0, GrayLevels::Quantized));
  write_json(answer_to_json(context, problem, design, layer), context.folder / "design.json");
  const Pattern drawn = draw_instance(design.pattern, design.print_seed).pattern;
  write_file(context.folder / "pattern.toml",
             pattern_file_text({drawn, patch_grid(context.experiment)},
                               "The design of \"" + context.experiment.title +
                                   "\": mezzotint synthesize pattern.toml -o relief.gwy"));
  outputs.insert(outputs.begin(), {"design.json", "pattern.toml", "gray.png", "relief.gwy"});
  return outputs;
}

}  // namespace

std::vector<std::string> run_search(const StageContext& context) {
  const Target target = target_from_json(read_json(context.folder / "target.json"));
  if (context.experiment.pattern.free_form) return search_free_form(context, target);
  return search_pattern_design(context, target);
}

}  // namespace mezzotint
