#include "experiments/calibration/calibration_findings.h"

#include <cmath>

#include <fmt/format.h>

namespace mezzotint {

namespace {

using Json = nlohmann::ordered_json;

std::optional<double> bound(double end) { return std::isfinite(end) ? std::optional(end) : std::nullopt; }

Interval95 interval_of(const FittedNumber& number) { return {bound(number.low_95), bound(number.high_95)}; }

// A bound that is not there is null.
Json json_of(const FittedNumber& number, const std::string& unit) {
  Json json = Quantity{number.value, unit, number.standard_error};
  const Interval95 ends = interval_of(number);
  json["low_95"] = ends.low ? Json(*ends.low) : Json(nullptr);
  json["high_95"] = ends.high ? Json(*ends.high) : Json(nullptr);
  return json;
}

Json json_of(const LevelInterval& level) {
  return {{"value", level.level}, {"unit", "level"}, {"low_95", level.low_95}, {"high_95", level.high_95}};
}

Json json_of(const ReachableRange& range) {
  Json json = {{"threshold_gray", range.threshold},
               {"first_level", json_of(range.first_level)},
               {"first_height", range.first_height},
               {"height_per_level_at_first", range.step_at_first},
               {"height_per_level_at_last", range.step_at_last},
               {"full_height", range.full_height}};
  json["saturation_level"] = range.saturation ? json_of(*range.saturation) : Json(nullptr);
  return json;
}

Json json_of(const FittedPoint& fitted) {
  return {{"place", fitted.point.place},
          {"gray", fitted.point.gray},
          {"exposure", fitted.point.exposure},
          {"height", Quantity{fitted.point.height_um, "µm", fitted.error_um}},
          {"predicted_um", fitted.predicted_um},
          {"residual_um", fitted.residual_um},
          {"role", std::string(role_name(fitted.role))},
          {"weight", fitted.weight}};
}

Json json_of(const WedgeScan& wedge) {
  Json steps = Json::array();
  for (const WedgeStep& step : wedge.steps)
    steps.push_back({{"gray", step.gray},
                     {"from_um", step.from.um()},
                     {"to_um", step.to.um()},
                     {"height", Quantity{step.height_um, "µm", step.standard_error_um}},
                     {"samples", step.samples},
                     {"outliers", step.outliers}});
  return {{"along", wedge.along == WedgeAxis::Y ? "y" : "x"},
          {"reversed", wedge.reversed},
          {"step_width", Quantity{wedge.step_width.um(), "µm", {}}},
          {"tilt", {wedge.tilt_x, wedge.tilt_y}},
          {"roughness", Quantity{wedge.roughness_um, "µm", {}}},
          {"base_standard_error_um", wedge.base_error_um},
          {"borders_standing_out", wedge.standing_out},
          {"steps", std::move(steps)},
          {"notes", wedge.notes}};
}

std::string with_error(const Quantity& quantity) {
  return fmt::format("{:.4g} ± {:.2g}{}", quantity.value, quantity.standard_error.value_or(0.0),
                     quantity.unit == "1" ? "" : " " + quantity.unit);
}

}  // namespace

CureRecord record_of(const CalibrationFindings& findings) {
  const CureFit& fit = findings.fit;
  return {.source = findings.source,
          .source_sha256 = findings.source_sha256,
          .steps = static_cast<std::int64_t>(fit.points.size()),
          .alpha_um = interval_of(fit.alpha_um),
          .beta_um = interval_of(fit.beta_um),
          .gamma = interval_of(fit.gamma),
          .gamma_determined = fit.gamma_is_determined,
          .chi_squared = fit.chi_squared,
          .degrees_of_freedom = fit.degrees_of_freedom};
}

std::vector<std::string> warnings_of(const CalibrationFindings& findings) {
  std::vector<std::string> warnings = findings.fit.notes;
  if (findings.wedge) warnings.insert(warnings.end(), findings.wedge->notes.begin(), findings.wedge->notes.end());
  const double layer_um = findings.printer.layer.um(), reached_um = findings.range.full_height.value;
  if (reached_um < layer_um)
    warnings.push_back(
        fmt::format("full gray cures {:.2f} um of the layer's {:g} um: a layer by itself stays {:.2f} um "
                    "thinner",
                    reached_um, layer_um, layer_um - reached_um));
  return warnings;
}

std::string in_words(const FittedNumber& number, const std::string& unit) {
  const std::string low = std::isfinite(number.low_95) ? fmt::format("{:.5g}", number.low_95) : "-inf";
  const std::string high = std::isfinite(number.high_95) ? fmt::format("{:.5g}", number.high_95) : "inf";
  return fmt::format("{:.5g} ± {:.2g}{}{}, 95 %: {} to {}", number.value, number.standard_error,
                     unit.empty() ? "" : " ", unit, low, high);
}

std::string in_words(const LevelInterval& level) {
  return fmt::format("level {} ({} to {})", level.level, level.low_95, level.high_95);
}

std::string in_words(const CalibrationFindings& findings) {
  const CureFit& fit = findings.fit;
  const ReachableRange& range = findings.range;
  std::string text = "alpha  " + in_words(fit.alpha_um, "µm") + "\n";
  text += "beta   " + in_words(fit.beta_um, "µm") + "\n";
  if (fit.gamma_is_determined) {
    text += "gamma  " + in_words(fit.gamma, "") + "\n";
  } else {
    text += fmt::format("gamma  {:.4g}, not determined\n", fit.gamma.value);
  }
  text += fmt::format("curing begins at gray {}: {} is the first that cures, {} high\n", with_error(range.threshold),
                      in_words(range.first_level), with_error(range.first_height));
  text += fmt::format("a level more is {} there, {} at the bright end\n", with_error(range.step_at_first),
                      with_error(range.step_at_last));
  text += range.saturation ? fmt::format("the layer of {:g} um is filled from {} on\n", findings.printer.layer.um(),
                                         in_words(*range.saturation))
                           : fmt::format("full gray reaches {}\n", with_error(range.full_height));
  if (fit.errors_were_given) {
    text += fmt::format("chi squared {:.4g} of {} degrees of freedom: a chance of {:.2g}\n", fit.chi_squared,
                        fit.degrees_of_freedom, fit.probability);
  } else {
    text += fmt::format("heights scatter by {:.3g} um about the curve ({} degrees of freedom)\n", fit.scale,
                        fit.degrees_of_freedom);
  }
  return text;
}

Json to_json(const CalibrationFindings& findings) {
  const CureFit& fit = findings.fit;
  Json json = {{"source", findings.source}, {"source_sha256", findings.source_sha256}};
  json["alpha"] = json_of(fit.alpha_um, "µm");
  json["beta"] = json_of(fit.beta_um, "µm");
  json["gamma"] = json_of(fit.gamma, "1");
  json["gamma_determined"] = fit.gamma_is_determined;
  json["covariance"] = fit.covariance;
  json["chi_squared"] = fit.errors_were_given ? Json(fit.chi_squared) : Json(nullptr);
  json["degrees_of_freedom"] = fit.degrees_of_freedom;
  json["probability"] = fit.errors_were_given ? Json(fit.probability) : Json(nullptr);
  json["error_scale"] = fit.scale;
  json["range"] = json_of(findings.range);
  json["steps"] = Json::array();
  for (const FittedPoint& point : fit.points) json["steps"].push_back(json_of(point));
  json["wedge"] = findings.wedge ? json_of(*findings.wedge) : Json(nullptr);
  json["warnings"] = warnings_of(findings);
  return json;
}

}  // namespace mezzotint
