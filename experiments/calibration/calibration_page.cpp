#include "experiments/calibration/calibration_page.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "experiments/report/components.h"

namespace mezzotint {

namespace {

using nlohmann::json;

// The gray value that gives the same dose at the profile's own exposure.
double same_dose(const CureCurve& curve, const CurePoint& point) {
  return point.exposure * (point.gray - curve.gamma) + curve.gamma;
}

json quantitative(const char* field, const std::string& title) {
  return {{"field", field}, {"type", "quantitative"}, {"title", title}, {"scale", {{"nice", true}, {"zero", false}}}};
}

json gray_axis(double largest) {
  json axis = quantitative("gray", "Gray level (at the profile's exposure)");
  axis["scale"] = {{"domain", {0.0, largest}}, {"nice", false}};
  axis["axis"] = {{"tickCount", 9}, {"format", "d"}};
  return axis;
}

struct Rows {
  json curve = json::array(), base = json::array(), points = json::array();
  double largest = 255.0;
};

Rows rows_of(const CalibrationFindings& findings) {
  const CureFit& fit = findings.fit;
  const int last = findings.printer.gray_levels - 1;
  Rows rows;
  rows.largest = last;
  for (const FittedPoint& fitted : fit.points) {
    const double level = last * same_dose(fit.curve, fitted.point);
    rows.largest = std::max(rows.largest, level);
    rows.points.push_back({{"gray", level},
                           {"height", fitted.point.height_um},
                           {"low", fitted.point.height_um - fit.quantile * fitted.error_um},
                           {"high", fitted.point.height_um + fit.quantile * fitted.error_um},
                           {"residual", fitted.residual_um},
                           {"residual_low", fitted.residual_um - fit.quantile * fitted.error_um},
                           {"residual_high", fitted.residual_um + fit.quantile * fitted.error_um},
                           {"exposure", fitted.point.exposure},
                           {"weight", fitted.weight},
                           {"place", fitted.point.place},
                           {"role", std::string(role_name(fitted.role))}});
  }
  const double layer_um = findings.printer.layer.um();
  for (double level = 0.0; level <= rows.largest; level += 0.5) {
    const double gray = level / last;
    const auto cut = [&](double height_um) { return std::clamp(height_um, 0.0, layer_um); };
    const double height_um = cut(gray_to_height(fit.curve, gray).um());
    const bool cures = gray > threshold_gray(fit.curve);
    const double reach_um = cures ? fit.quantile * height_error_um(fit, gray) : 0.0;
    rows.curve.push_back({{"gray", level},
                          {"height", height_um},
                          {"low", cut(height_um - reach_um)},
                          {"high", cut(height_um + reach_um)}});
    rows.base.push_back({{"gray", level}, {"height", cut(gray_to_height(findings.base.cure, gray).um())}});
  }
  return rows;
}

json role_colour() {
  return {{"field", "role"},
          {"type", "nominal"},
          {"title", nullptr},
          {"legend", {{"orient", "top"}, {"symbolType", "circle"}}},
          {"scale",
           {{"domain", {"measured", "below cure", "saturated"}}, {"range", {"$series-1", "$series-3", "$series-2"}}}}};
}

json error_bars(const json& points, const json& x, const char* low, const char* high, const std::string& title) {
  json y = quantitative(low, title);
  return {{"data", {{"values", points}}},
          {"mark", {{"type", "rule"}, {"strokeWidth", 1.4}}},
          {"encoding", {{"x", x}, {"y", y}, {"y2", {{"field", high}}}, {"color", role_colour()}}}};
}

json marks(const json& points, const json& x, const char* field, const std::string& title) {
  return {{"data", {{"values", points}}},
          {"mark", {{"type", "point"}, {"filled", true}, {"size", 42}, {"opacity", 1}}},
          {"encoding",
           {{"x", x},
            {"y", quantitative(field, title)},
            {"color", role_colour()},
            {"tooltip",
             {{{"field", "place"}},
              {{"field", "height"}, {"title", "height (µm)"}, {"format", ".3f"}},
              {{"field", "residual"}, {"title", "residual (µm)"}, {"format", "+.3f"}},
              {{"field", "exposure"}, {"format", ".3g"}},
              {{"field", "weight"}, {"format", ".2f"}}}}}}};
}

json curve_chart(const CalibrationFindings& findings, const Rows& rows) {
  const std::string title = "Height (µm)";
  const json x = gray_axis(rows.largest);
  json layers = json::array();
  layers.push_back({{"data", {{"values", rows.curve}}},
                    {"mark", {{"type", "area"}, {"color", "$ink"}, {"opacity", 0.16}}},
                    {"encoding", {{"x", x}, {"y", quantitative("low", title)}, {"y2", {{"field", "high"}}}}}});
  layers.push_back({{"data", {{"values", rows.base}}},
                    {"mark", {{"type", "line"}, {"color", "$quiet"}, {"strokeDash", {4, 4}}, {"strokeWidth", 1.4}}},
                    {"encoding", {{"x", x}, {"y", quantitative("height", title)}}}});
  layers.push_back({{"data", {{"values", rows.curve}}},
                    {"mark", {{"type", "line"}, {"color", "$ink"}, {"strokeWidth", 1.6}}},
                    {"encoding", {{"x", x}, {"y", quantitative("height", title)}}}});
  layers.push_back(error_bars(rows.points, x, "low", "high", title));
  layers.push_back(marks(rows.points, x, "height", title));
  return vega_lite_chart(
      {.title = "Cure curve",
       .caption = fmt::format("Line: α + β ln(I − γ), within 0 and the layer of {:g} µm; band and bars: 95 %. Dashed: "
                              "the base profile's curve.",
                              findings.printer.layer.um()),
       .span = Span::Full,
       .alt = "Measured heights of steps over gray levels, with the fitted cure curve and its band"},
      {{"width", "container"}, {"height", 380}, {"layer", layers}});
}

json residual_chart(const Rows& rows) {
  const std::string title = "Measured − curve (µm)";
  const json x = gray_axis(rows.largest);
  json layers = json::array();
  layers.push_back({{"data", {{"values", json::array({{{"zero", 0.0}}})}}},
                    {"mark", {{"type", "rule"}, {"color", "$quiet"}}},
                    {"encoding", {{"y", quantitative("zero", title)}}}});
  layers.push_back(error_bars(rows.points, x, "residual_low", "residual_high", title));
  layers.push_back(marks(rows.points, x, "residual", title));
  return vega_lite_chart({.title = "Residuals",
                          .caption = "Bars: 95 % of each step. Steps below cure and saturated ones count by what they "
                                     "bound, not by their residual.",
                          .span = Span::Full,
                          .alt = "Residuals of the steps over gray levels"},
                         {{"width", "container"}, {"height", 220}, {"layer", layers}});
}

// At most some two thousand points of the profile: means of neighbours.
json profile_chart(const WedgeScan& wedge) {
  const std::size_t every = wedge.profile_um.size() / 2000 + 1;
  json rows = json::array(), steps = json::array();
  for (std::size_t i = 0; i < wedge.profile_um.size(); i += every) {
    double sum = 0.0, count = 0.0;
    for (std::size_t k = i; k < std::min(i + every, wedge.profile_um.size()); ++k) {
      if (std::isnan(wedge.profile_um[k])) continue;
      sum += wedge.profile_um[k];
      count += 1.0;
    }
    if (count > 0.0)
      rows.push_back(
          {{"x", wedge.profile_start.um() +
                     wedge.profile_pitch.um() * (static_cast<double>(i) + 0.5 * static_cast<double>(every - 1))},
           {"height", sum / count}});
  }
  for (const WedgeStep& step : wedge.steps)
    steps.push_back({{"x", step.from.um()},
                     {"end", step.to.um()},
                     {"height", step.height_um},
                     {"level", std::lround(255.0 * step.gray)}});
  const json x = quantitative("x", "Along the wedge (µm)"), y = quantitative("height", "Height (µm)");
  json layers = json::array();
  layers.push_back({{"data", {{"values", steps}}},
                    {"mark", {{"type", "rule"}, {"color", "$quiet"}, {"strokeDash", {2, 3}}}},
                    {"encoding", {{"x", x}}}});
  layers.push_back({{"data", {{"values", rows}}},
                    {"mark", {{"type", "line"}, {"color", "$series-1"}, {"strokeWidth", 1.2}}},
                    {"encoding", {{"x", x}, {"y", y}}}});
  layers.push_back({{"data", {{"values", steps}}},
                    {"mark", {{"type", "rule"}, {"color", "$ink"}, {"strokeWidth", 3}}},
                    {"encoding",
                     {{"x", x},
                      {"x2", {{"field", "end"}}},
                      {"y", y},
                      {"tooltip", {{{"field", "level"}}, {{"field", "height"}, {"format", ".3f"}}}}}}});
  return vega_lite_chart(
      {.title = "The wedge in the scan",
       .caption = "Median across the steps, without the plate's tilt, over the base; heavy: what was "
                  "taken for each step; dotted: borders.",
       .span = Span::Full,
       .alt = "Profile of the wedge with the steps that were found"},
      {{"width", "container"}, {"height", 260}, {"layer", layers}});
}

json parameter_table(const CureFit& fit) {
  const auto row = [](const char* name, const FittedNumber& number, const std::string& unit) {
    const auto end = [](double value) { return std::isfinite(value) ? fmt::format("{:.5g}", value) : "no bound"; };
    return TableRow{
        {name, Quantity{number.value, unit, number.standard_error}, end(number.low_95), end(number.high_95)}};
  };
  TableRow gamma = row("γ", fit.gamma, "1");
  if (!fit.gamma_is_determined) gamma.cells[1] = fmt::format("{:.4g}, not determined", fit.gamma.value);
  return table({.title = "Parameters", .caption = "Intervals by profile likelihood.", .span = Span::Half},
               {"parameter", "value", "95 % from", "to"},
               {row("α", fit.alpha_um, "µm"), row("β", fit.beta_um, "µm"), gamma});
}

json range_table(const CalibrationFindings& findings) {
  const ReachableRange& range = findings.range;
  std::vector<TableRow> rows{{{"curing begins at gray", range.threshold}},
                             {{"first gray that cures", in_words(range.first_level)}},
                             {{"its height", range.first_height}},
                             {{"height a level there", range.step_at_first}},
                             {{"height a level at the bright end", range.step_at_last}},
                             {{"highest of one layer", range.full_height}}};
  rows.push_back({{"fills the layer from", range.saturation ? in_words(*range.saturation) : "no level"}});
  return table({.title = "What one layer reaches", .span = Span::Half}, {"figure", "value"}, rows);
}

json step_table(const CureFit& fit) {
  std::vector<TableRow> rows;
  for (const FittedPoint& fitted : fit.points) {
    const Outcome outcome = fitted.weight < suspicious_weight ? Outcome::Missed : Outcome::Information;
    rows.push_back(
        {{fitted.point.place, fmt::format("{:.4g}", 255.0 * fitted.point.gray),
          fmt::format("{:.3g}", fitted.point.exposure), Quantity{fitted.point.height_um, "µm", fitted.error_um},
          fmt::format("{:.3f}", fitted.predicted_um), fmt::format("{:+.3f}", fitted.residual_um),
          std::string(role_name(fitted.role)), fmt::format("{:.2f}", fitted.weight)},
         outcome});
  }
  return table({.title = "Steps", .span = Span::Full},
               {"step", "level", "exposure", "height", "curve (µm)", "residual (µm)", "counts as", "weight"}, rows);
}

std::vector<KeyFigure> key_figures(const CalibrationFindings& findings) {
  const CureFit& fit = findings.fit;
  const auto figure = [](const char* name, const FittedNumber& number, const char* unit, bool is_fitted) {
    KeyFigure key;
    key.name = name;
    key.quantity = {number.value, unit, is_fitted ? std::optional(number.standard_error) : std::nullopt};
    return key;
  };
  KeyFigure first;
  first.name = "First level";
  first.quantity.value = findings.range.first_level.level;
  first.note = "the first that cures";
  KeyFigure gamma = figure("γ", fit.gamma, "1", fit.gamma_is_determined);
  if (!fit.gamma_is_determined) gamma.note = "not determined: the base profile's";
  return {figure("α", fit.alpha_um, "µm", true), figure("β", fit.beta_um, "µm", true), gamma, first};
}

Verdict verdict_of(const CalibrationFindings& findings) {
  const CureFit& fit = findings.fit;
  std::string text = fmt::format("Height = {:.2f} + {:.2f} ln(I {} {:.4f}) µm", fit.curve.alpha.um(),
                                 fit.curve.beta.um(), fit.curve.gamma < 0.0 ? "+" : "−", std::abs(fit.curve.gamma));
  text += fit.gamma_is_determined ? "." : "; γ is not determined by these steps.";
  return {Outcome::Information, text};
}

}  // namespace

Report calibration_page(const CalibrationFindings& findings) {
  const CureFit& fit = findings.fit;
  const Rows rows = rows_of(findings);
  Report page{.title = "Calibration of " + findings.printer.name,
              .subtitle = fmt::format("{} steps of {}", fit.points.size(), findings.source),
              .verdict = verdict_of(findings),
              .key_figures = key_figures(findings)};
  for (const std::string& warning : warnings_of(findings)) page.messages.push_back({MessageLevel::Note, warning});
  std::string text = fit.errors_were_given ? fmt::format("χ² {:.4g} of {} degrees of freedom, a chance of {:.2g}.",
                                                         fit.chi_squared, fit.degrees_of_freedom, fit.probability)
                                           : fmt::format("Heights scatter by {:.3g} µm about the curve.", fit.scale);
  text += " Steps that lie far off count less (Student's loss).";
  page.sections.push_back({"Curve", text, {curve_chart(findings, rows), residual_chart(rows)}});
  page.sections.push_back({"Figures", "", {parameter_table(fit), range_table(findings)}});
  if (findings.wedge) {
    const WedgeScan& wedge = *findings.wedge;
    page.sections.push_back(
        {"Scan",
         fmt::format("Steps {:.1f} µm wide; tilt of the plate {:.2g}, {:.2g} taken out; roughness {:.3g} "
                     "µm; the base's height is known to {:.2g} µm, which α carries.",
                     wedge.step_width.um(), wedge.tilt_x, wedge.tilt_y, wedge.roughness_um, wedge.base_error_um),
         {profile_chart(wedge)}});
  }
  page.sections.push_back({"Steps", "", {step_table(fit)}});
  page.provenance["source"] = findings.source;
  page.provenance["SHA-256"] = findings.source_sha256;
  page.provenance["base profile"] = findings.base.name;
  return page;
}

}  // namespace mezzotint
