#include "experiments/run/run_files.h"

#include <cmath>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "forward/base/file_input.h"
#include "forward/base/file_output.h"
#include "forward/pattern/pattern_parameters.h"

namespace mezzotint {

namespace {

using Json = nlohmann::ordered_json;

Json quantity(double value, const char* unit, double standard_error) { return Quantity{value, unit, standard_error}; }

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

// A picture of labels, as runs: how many pixels, of which label.
Json labels_to_json(const PatternRegions& regions) {
  Json runs = Json::array();
  for (std::size_t first = 0; first < regions.labels.size();) {
    std::size_t end = first;
    while (end < regions.labels.size() && regions.labels[end] == regions.labels[first]) ++end;
    runs.push_back({end - first, regions.labels[first]});
    first = end;
  }
  return {{"source", regions.source}, {"columns", regions.columns}, {"rows", regions.rows}, {"runs", runs}};
}
void labels_from_json(const Json& json, PatternRegions& regions) {
  regions.source = json.at("source");
  regions.columns = json.at("columns");
  regions.rows = json.at("rows");
  for (const Json& run : json.at("runs")) {
    regions.labels.insert(regions.labels.end(), run.at(0).get<std::size_t>(), run.at(1).get<std::uint8_t>());
  }
}

Json pattern_to_json(const Pattern& pattern);
Pattern pattern_from_json(const Json& json);

Json parts_to_json(const std::vector<PatternPart>& parts) {
  Json list = Json::array();
  for (const PatternPart& part : parts) {
    list.push_back(pattern_to_json(part.pattern));
    list.back()["label"] = part.label;
  }
  return list;
}
template <typename Kind>
void parts_from_json(const Json& json, Kind& kind) {
  if constexpr (requires { kind.parts; }) {
    for (const Json& part : json.at("parts")) kind.parts.push_back({pattern_from_json(part), part.at("label")});
  }
}

Json pattern_to_json(const Pattern& pattern) {
  Json json = {{"kind", kind_name(pattern)}};
  for (const auto& parameter : pattern_parameters(pattern)) {
    json[parameter.name] = get_parameter(pattern, parameter.name);
  }
  if (const auto random = randomness(pattern)) {
    json["seed"] = random->seed;
    json["hash"] = random->hash == CellHash::Slides ? "slides" : "integer";
  }
  if (const auto* lines = std::get_if<LineIntegralConvolution>(&pattern)) {
    json["singularities"] = Json::array();
    for (const Singularity& point : lines->singularities) {
      json["singularities"].push_back({point.place.x.um(), point.place.y.um(), point.index});
    }
  }
  if (const auto* parts = parts_of(pattern)) json["parts"] = parts_to_json(*parts);
  if (const auto* regions = std::get_if<PatternRegions>(&pattern)) json["labels"] = labels_to_json(*regions);
  return json;
}
Pattern pattern_from_json(const Json& json) {
  Pattern pattern = default_pattern(json.at("kind").get<std::string>());
  for (const auto& parameter : pattern_parameters(pattern)) {
    set_parameter(pattern, parameter.name, json.at(parameter.name));
  }
  if (randomness(pattern)) {
    set_randomness(pattern, {json.at("seed"), json.at("hash") == "slides" ? CellHash::Slides : CellHash::Integer});
  }
  if (auto* lines = std::get_if<LineIntegralConvolution>(&pattern)) {
    for (const Json& point : json.at("singularities")) {
      lines->singularities.push_back({{Length::from_um(point.at(0)), Length::from_um(point.at(1))}, point.at(2)});
    }
  }
  std::visit([&json](auto& kind) { parts_from_json(json, kind); }, pattern);
  if (auto* regions = std::get_if<PatternRegions>(&pattern)) labels_from_json(json.at("labels"), *regions);
  return pattern;
}

Json step_to_json(const SearchStep& step) {
  const Json objective = std::isfinite(step.objective) ? Json(step.objective) : Json(nullptr);
  return {{"values", step.values}, {"objective", objective}};
}
SearchStep step_from_json(const Json& json) {
  const Json& objective = json.at("objective");
  return {json.at("values"), objective.is_null() ? std::nan("") : objective.get<double>()};
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
               {"search",
                {{"best", step_to_json(design.search.best)},
                 {"evaluations", design.search.evaluations},
                 {"outcome", design.search.outcome},
                 {"converged", design.search.converged}}},
               {"fresh_seeds", design.fresh_seeds},
               {"print_seed", design.print_seed}};
  if (design.fresh_lobe_error) {
    json["fresh_lobe_error"] = {design.fresh_lobe_error->value, design.fresh_lobe_error->standard_error};
  }
  for (const auto& c : design.fresh_covariances) json["fresh_covariances"].push_back({c.xx, c.yy, c.xy});
  for (const auto& variable : design.variables) json["variables"].push_back(variable_to_json(variable));
  for (const auto& step : design.history) json["history"].push_back(step_to_json(step));
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
  const Json& search = json.at("search");
  design.search = {step_from_json(search.at("best")), search.at("evaluations"), search.at("outcome"),
                   search.at("converged")};
  design.fresh_seeds = json.at("fresh_seeds").get<std::vector<std::uint64_t>>();
  design.print_seed = json.at("print_seed");
  for (const Json& c : json.at("fresh_covariances")) design.fresh_covariances.push_back({c.at(0), c.at(1), c.at(2)});
  for (const Json& variable : json.at("variables")) design.variables.push_back(variable_from_json(variable));
  for (const Json& step : json.at("history")) design.history.push_back(step_from_json(step));
  return design;
}

Json to_json(const Registration& r) {
  return {{"shift_x", quantity(r.shift_x.value.um(), "µm", r.shift_x.standard_error.um())},
          {"shift_y", quantity(r.shift_y.value.um(), "µm", r.shift_y.standard_error.um())},
          {"rotation", quantity(r.rotation.value.degrees(), "°", r.rotation.standard_error.degrees())},
          {"correlation", r.correlation},
          {"runner_up", r.runner_up},
          {"overlap", r.overlap}};
}

Json to_json(const AreaRoughness& roughness) {
  return {{"Sa", roughness.Sa},   {"Sq", roughness.Sq},           {"Sz", roughness.Sz},
          {"Ssk", roughness.Ssk}, {"Sku", roughness.Sku},         {"Sdq", roughness.Sdq},
          {"Sdr", roughness.Sdr}, {"samples", roughness.samples}, {"missing", roughness.missing}};
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

Json read_json(const std::filesystem::path& path) {
  const auto bytes = read_file(path);
  const auto* text = reinterpret_cast<const char*>(bytes.data());
  Json json = Json::parse(text, text + bytes.size(), nullptr, false);
  if (json.is_discarded()) throw FileError(path, "", "is not valid JSON");
  return json;
}

void write_json(const Json& json, const std::filesystem::path& path) { write_file(path, json.dump(2) + "\n"); }

}  // namespace mezzotint
