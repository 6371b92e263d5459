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

Json estimate_to_json(const Estimate& e) { return {number_to_json(e.value), number_to_json(e.standard_error)}; }
Estimate plain_estimate_from_json(const Json& json) {
  return {number_from_json(json.at(0)), number_from_json(json.at(1))};
}

LobeDistance lobe_distance_named(const std::string& name) { return lobe_distance_of(measure_named(name)).value(); }

// The figures; the maps themselves are images of their own.
Json judgement_to_json(const LobeJudgement& judgement) {
  Json json = {{"distances", Json::array()}, {"reflected", Json::array()}};
  for (const JudgedDistance& d : judgement.distances) {
    json["distances"].push_back({{"distance", name_of(d.distance)},
                                 {"square", estimate_to_json(d.square)},
                                 {"root", estimate_to_json(d.root)},
                                 {"floor", estimate_to_json(d.floor)},
                                 {"root_floor", number_to_json(d.root_floor)}});
  }
  for (const Estimate& light : judgement.reflected) json["reflected"].push_back(estimate_to_json(light));
  return json;
}
LobeJudgement judgement_from_json(const Json& json) {
  LobeJudgement judgement;
  for (const Json& d : json.at("distances")) {
    judgement.distances.push_back({lobe_distance_named(d.at("distance").get<std::string>()),
                                   plain_estimate_from_json(d.at("square")), plain_estimate_from_json(d.at("root")),
                                   plain_estimate_from_json(d.at("floor")), number_from_json(d.at("root_floor"))});
  }
  for (const Json& light : json.at("reflected")) judgement.reflected.push_back(plain_estimate_from_json(light));
  return judgement;
}

Json to_json_figures(const Verification& v) {
  Json json = {{"seeds", v.seeds},
               {"traced", judgement_to_json(v.traced)},
               {"by_slope", judgement_to_json(v.by_slope)},
               {"wanted_light", v.wanted_light}};
  for (const EnergyAudit& audit : v.energy) {
    json["energy"].push_back({{"reflected", estimate_to_json(audit.reflected)},
                              {"transmitted", estimate_to_json(audit.transmitted)},
                              {"absorbed", estimate_to_json(audit.absorbed)},
                              {"left_sideways", estimate_to_json(audit.left_sideways)},
                              {"cut_off", estimate_to_json(audit.cut_off)}});
  }
  return json;
}
Verification figures_from_json(const Json& json) {
  Verification v{.seeds = json.at("seeds"),
                 .traced = judgement_from_json(json.at("traced")),
                 .by_slope = judgement_from_json(json.at("by_slope")),
                 .wanted_light = json.at("wanted_light")};
  for (const Json& audit : json.at("energy")) {
    const auto share = [&](const char* name) { return plain_estimate_from_json(audit.at(name)); };
    v.energy.push_back(
        {share("reflected"), share("transmitted"), share("absorbed"), share("left_sideways"), share("cut_off")});
  }
  return v;
}

Json intervals_to_json(const ParameterIntervals& intervals) {
  Json json = {{"half_widths_95", Json::array()}, {"combinations", Json::array()}};
  for (const double width : intervals.half_widths_95) json["half_widths_95"].push_back(number_to_json(width));
  for (const ParameterCombination& c : intervals.combinations) {
    json["combinations"].push_back(
        {{"change", c.change}, {"half_width_95", number_to_json(c.half_width_95)}, {"determined", c.determined}});
  }
  return json;
}
// A width that is not finite is unbounded.
double width_from_json(const Json& json) { return json.is_null() ? HUGE_VAL : json.get<double>(); }
ParameterIntervals intervals_from_json(const Json& json) {
  ParameterIntervals intervals;
  for (const Json& width : json.at("half_widths_95")) intervals.half_widths_95.push_back(width_from_json(width));
  for (const Json& c : json.at("combinations"))
    intervals.combinations.push_back({c.at("change"), width_from_json(c.at("half_width_95")), c.at("determined")});
  return intervals;
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

Json to_json(const Verification& verification) { return to_json_figures(verification); }
Verification verification_from_json(const Json& json) { return figures_from_json(json); }

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
  if (design.on_search_lobes) json["on_search_lobes"] = judgement_to_json(*design.on_search_lobes);
  if (design.on_fresh_lobes) json["on_fresh_lobes"] = judgement_to_json(*design.on_fresh_lobes);
  if (design.traced) json["traced"] = to_json(*design.traced);
  json["held_out_ratio"] = number_to_json(design.held_out_ratio);
  json["intervals"] = intervals_to_json(design.intervals);
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
  if (json.contains("on_search_lobes")) design.on_search_lobes = judgement_from_json(json["on_search_lobes"]);
  if (json.contains("on_fresh_lobes")) design.on_fresh_lobes = judgement_from_json(json["on_fresh_lobes"]);
  if (json.contains("traced")) design.traced = verification_from_json(json["traced"]);
  design.held_out_ratio = number_from_json(json.at("held_out_ratio"));
  design.intervals = intervals_from_json(json.at("intervals"));
  return design;
}

std::string verdict_sentence(const Target& target, const Design& design) {
  const char* verdict = !is_judged(target) ? "No tolerance stated" : design.met ? "Target met" : "Target missed";
  const std::size_t draws = design.fresh_covariances.size();
  if (design.fresh_lobe_error) {
    const std::size_t seen = design.traced ? design.traced->seeds.size() : draws;
    const std::string allowed = is_judged(target) ? fmt::format(" ({:.3g} allowed)", target.tolerance) : "";
    return fmt::format(
        "{}: on {} draws that the search never saw, the printed lobe's cube-root error is {:.3f} ± {:.3f}{}.", verdict,
        seen, design.fresh_lobe_error->value, design.fresh_lobe_error->standard_error, allowed);
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
