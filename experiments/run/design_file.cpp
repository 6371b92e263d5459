#include "experiments/run/design_file.h"

#include <cmath>

#include <fmt/format.h>

#include "experiments/run/pattern_json.h"

namespace mezzotint {

namespace {

using Json = nlohmann::ordered_json;

Json axes_to_json(const SlopeAxes& axes) {
  return {{"rms_major", axes.rms_major}, {"rms_minor", axes.rms_minor}, {"rotation_rad", axes.rotation.radians()}};
}
SlopeAxes axes_from_json(const Json& json) {
  return {json.at("rms_major"), json.at("rms_minor"), Angle::from_radians(json.at("rotation_rad"))};
}

Json estimate_to_json(const SlopeAxesEstimate& estimate) {
  return {{"axes", axes_to_json(estimate.axes)},
          {"rms_major_error", estimate.rms_major_error},
          {"rms_minor_error", estimate.rms_minor_error},
          {"rotation_error_rad", estimate.rotation_error.radians()}};
}
SlopeAxesEstimate estimate_from_json(const Json& json) {
  return {axes_from_json(json.at("axes")), json.at("rms_major_error"), json.at("rms_minor_error"),
          Angle::from_radians(json.at("rotation_error_rad"))};
}

// A number that need not be finite.
Json number_to_json(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
double number_from_json(const Json& json) { return json.is_null() ? std::nan("") : json.get<double>(); }

Json search_to_json(const SearchOutcome& search) {
  Json json = {{"values", search.values},       {"objective", number_to_json(search.objective)},
               {"cost", search.cost},           {"outcome", search.outcome},
               {"converged", search.converged}, {"shape_fits", search.shape_fits}};
  for (const WeightedMeasure& term : search.lowered)
    json["lowered"].push_back({{"measure", name_of(term.measure)}, {"weight", term.weight}});
  json["history"] = Json::array();
  for (const DesignStep& step : search.history) {
    json["history"].push_back({{"stage", step.stage},
                               {"values", step.step.values},
                               {"objective", number_to_json(step.step.objective)},
                               {"cost", step.cost}});
  }
  return json;
}
SearchOutcome search_from_json(const Json& json) {
  SearchOutcome search{.values = json.at("values"), .objective = number_from_json(json.at("objective"))};
  search.cost = json.at("cost");
  search.outcome = json.at("outcome");
  search.converged = json.at("converged");
  search.shape_fits = json.at("shape_fits");
  for (const Json& term : json.at("lowered"))
    search.lowered.push_back({measure_named(term.at("measure").get<std::string>()), term.at("weight")});
  for (const Json& step : json.at("history")) {
    search.history.push_back(
        {step.at("stage"), {step.at("values"), number_from_json(step.at("objective"))}, step.at("cost")});
  }
  return search;
}

Json distance_to_json(const JudgedDistance& d) {
  return {{"measure", name_of(d.measure)},
          {"on_search_draws", d.on_search_draws},
          {"floor", number_to_json(d.floor)},
          {"on_fresh_draws", {d.on_fresh_draws.value, number_to_json(d.on_fresh_draws.standard_error)}},
          {"fresh_floor", number_to_json(d.fresh_floor)}};
}
JudgedDistance distance_from_json(const Json& json) {
  const Json& fresh = json.at("on_fresh_draws");
  return {measure_named(json.at("measure").get<std::string>()),
          json.at("on_search_draws"),
          number_from_json(json.at("floor")),
          {fresh.at(0).get<double>(), number_from_json(fresh.at(1))},
          number_from_json(json.at("fresh_floor"))};
}

Json variable_to_json(const Variable& variable) {
  return {{"name", variable.name},
          {"low", variable.low},
          {"high", variable.high},
          {"start", variable.start},
          {"logarithmic", variable.logarithmic}};
}
Variable variable_from_json(const Json& json) {
  return {json.at("name"), json.at("low"), json.at("high"), json.at("start"), json.at("logarithmic")};
}

}  // namespace

Json to_json(const Target& target) {
  return {{"kind", target.kind},
          {"slopes", axes_to_json(target.slopes)},
          {"rotation_matters", target.rotation_matters},
          {"tolerance", is_judged(target) ? Json(target.tolerance) : Json(nullptr)},
          {"rotation_tolerance_rad", target.rotation_tolerance.radians()}};
}

Target target_from_json(const Json& json) {
  return {.kind = json.at("kind"),
          .slopes = axes_from_json(json.at("slopes")),
          .rotation_matters = json.at("rotation_matters"),
          .tolerance = json.at("tolerance").is_null() ? HUGE_VAL : json["tolerance"].get<double>(),
          .rotation_tolerance = Angle::from_radians(json.at("rotation_tolerance_rad"))};
}

Json to_json(const Design& design) {
  Json json = {{"pattern", pattern_to_json(design.pattern)},
               {"met", design.met},
               {"warnings", design.warnings},
               {"on_search_draws", estimate_to_json(design.on_search_draws)},
               {"on_fresh_draws", estimate_to_json(design.on_fresh_draws)},
               {"fresh_error",
                {{"variance_major", design.fresh_error.variance_major},
                 {"variance_minor", design.fresh_error.variance_minor},
                 {"rotation_rad", design.fresh_error.rotation.radians()}}},
               {"search", search_to_json(design.search)},
               {"fresh_seeds", design.fresh_seeds},
               {"print_seed", design.print_seed}};
  if (design.fresh_lobe_error) {
    json["fresh_lobe_error"] = {design.fresh_lobe_error->value, design.fresh_lobe_error->standard_error};
  }
  for (const auto& c : design.fresh_covariances) json["fresh_covariances"].push_back({c.xx, c.yy, c.xy});
  for (const auto& variable : design.variables) json["variables"].push_back(variable_to_json(variable));
  for (const auto& distance : design.distances) json["distances"].push_back(distance_to_json(distance));
  return json;
}

Design design_from_json(const Json& json) {
  Design design{.pattern = pattern_from_json(json.at("pattern"))};
  design.met = json.at("met");
  design.warnings = json.at("warnings").get<std::vector<std::string>>();
  design.on_search_draws = estimate_from_json(json.at("on_search_draws"));
  design.on_fresh_draws = estimate_from_json(json.at("on_fresh_draws"));
  const Json& error = json.at("fresh_error");
  design.fresh_error = {error.at("variance_major"), error.at("variance_minor"),
                        Angle::from_radians(error.at("rotation_rad"))};
  if (json.contains("fresh_lobe_error")) {
    const Json& lobe = json["fresh_lobe_error"];
    design.fresh_lobe_error = Estimate{lobe.at(0), lobe.at(1)};
  }
  design.search = search_from_json(json.at("search"));
  design.fresh_seeds = json.at("fresh_seeds").get<std::vector<std::uint64_t>>();
  design.print_seed = json.at("print_seed");
  for (const Json& c : json.at("fresh_covariances")) design.fresh_covariances.push_back({c.at(0), c.at(1), c.at(2)});
  for (const Json& variable : json.at("variables")) design.variables.push_back(variable_from_json(variable));
  for (const Json& distance : json.at("distances")) design.distances.push_back(distance_from_json(distance));
  return design;
}

std::string verdict_sentence(const Target& target, const Design& design) {
  const char* verdict = !is_judged(target) ? "No tolerance stated" : design.met ? "Target met" : "Target missed";
  const std::size_t draws = design.fresh_covariances.size();
  if (design.fresh_lobe_error) {
    const std::string allowed = is_judged(target) ? fmt::format(" ({:.3g} allowed)", target.tolerance) : "";
    return fmt::format(
        "{}: on {} draws that the search never saw, the printed lobe's cube-root error is {:.3f} ± {:.3f}{}.", verdict,
        draws, design.fresh_lobe_error->value, design.fresh_lobe_error->standard_error, allowed);
  }
  const TargetError& error = design.fresh_error;
  const std::string axis = target.rotation_matters
                               ? fmt::format(", and their axis by {:.2f}° ({:.3g}° allowed)", error.rotation.degrees(),
                                             target.rotation_tolerance.degrees())
                               : "";
  return fmt::format(
      "{}: on {} draws that the search never saw, the printed slopes' variances are off by {:+.1f} % and "
      "{:+.1f} % ({:.3g} % allowed){}.",
      verdict, draws, 100.0 * error.variance_major, 100.0 * error.variance_minor, 100.0 * target.tolerance, axis);
}

}  // namespace mezzotint
