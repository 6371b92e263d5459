#include "experiments/run/search_free_form.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "experiments/run/design_answer.h"
#include "experiments/run/design_file.h"
#include "experiments/run/run_files.h"
#include "experiments/run/target_lobes.h"
#include "forward/base/error.h"
#include "inverse/free_form/free_form.h"

namespace mezzotint {

namespace {

using Json = nlohmann::ordered_json;

FreeFormOptions options_of(const StageContext& context) {
  const Experiment& experiment = context.experiment;
  FreeFormOptions options = *experiment.pattern.free_form;
  options.fresh_draws = std::clamp<std::size_t>(experiment.search.fresh_draws, 4, 64);
  options.wavelength = experiment.simulation.wavelength;
  options.seed = experiment.search.minimize.seed;
  options.state = context.folder / "free_form.state";
  return options;
}

Json to_json(const FreeForm& found, const Target& target) {
  const Estimate& error = found.verified.traced.by(LobeDistance::CubeRoot).root;
  Json json = {{"free_form",
                {{"start", found.start},
                 {"evaluations", found.evaluations},
                 {"on_search_draws", found.on_search_draws},
                 {"history", found.history}}},
               {"met", error.value <= target.tolerance},
               {"tolerance", is_judged(target) ? Json(target.tolerance) : Json(nullptr)},
               {"warnings", found.warnings},
               {"fresh_lobe_error", {error.value, error.standard_error}},
               {"traced", to_json(found.verified)},
               {"figures", figures_to_json(found.verified)}};
  json["print_seed"] = found.verified.seeds.front();
  return json;
}

}  // namespace

std::vector<std::string> search_free_form(const StageContext& context, const Target& target) {
  const Experiment& experiment = context.experiment;
  const auto goal = target_lobes(experiment, context.folder, target);
  require(goal.has_value(), "a free form is searched for a lobe; an anisotropy alone names none");
  const FreeFormOptions options = options_of(context);
  const FreeForm found = find_free_form(*goal, experiment.printer, options, context.progress);
  const DrawOptions draw{.surround = Surround::Repeat, .wavelength = options.wavelength};
  Json json = to_json(found, target);
  json["gamut"] = read_json(context.folder / "gamut.json");
  const std::uint64_t seed = found.verified.seeds.front();
  json["gray"] = write_layer(context, found.gray, print_draw(found.gray, experiment.printer, draw, seed));
  json["blur"] =
      to_json(experiment.printer, blur_sensitivity(found.gray, experiment.printer, *goal, draw, found.verified.seeds));
  std::vector<std::string> outputs = write_lobes(context, *goal, found.verified);
  write_json(json, context.folder / "design.json");
  outputs.insert(outputs.begin(), {"design.json", "gray.png", "relief.gwy"});
  return outputs;
}

std::string free_form_verdict(const Json& json) {
  const bool judged = !json.at("tolerance").is_null();
  const char* verdict = !judged ? "No tolerance stated" : json.at("met").get<bool>() ? "Target met" : "Target missed";
  const std::string allowed = judged ? fmt::format(" ({:.3g} allowed)", json.at("tolerance").get<double>()) : "";
  return fmt::format(
      "{}: printed anew and traced on {} grounds that the search never saw, the lobe's cube-root error is {:.3f} ± "
      "{:.3f}{}.",
      verdict, json.at("traced").at("seeds").size(), json.at("fresh_lobe_error").at(0).get<double>(),
      json.at("fresh_lobe_error").at(1).get<double>(), allowed);
}

}  // namespace mezzotint
