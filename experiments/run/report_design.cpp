#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "experiments/report/charts.h"
#include "experiments/report/components.h"
#include "experiments/run/report_page.h"
#include "forward/pattern/pattern_parameters.h"

namespace mezzotint {

namespace {

std::string unit_of(std::string_view parameter) {
  if (parameter.ends_with("_um")) return "µm";
  return parameter.ends_with("_deg") ? "°" : "1";
}

nlohmann::json parameter_table(const RunResults& results) {
  std::vector<TableRow> rows;
  for (const auto& parameter : all_parameters(results.design.pattern)) {
    if (parameter.drawn) continue;
    const std::string& name = parameter.name;
    const Quantity value{get_parameter(results.design.pattern, name), unit_of(name), {}};
    const auto found = std::ranges::find(results.design.variables, name, &Variable::name);
    const bool is_free = found != results.design.variables.end();
    rows.push_back({{name, value, is_free ? fmt::format("{:.4g}", found->start) : "–",
                     is_free ? fmt::format("{:g} … {:g}", found->low, found->high) : "fixed"}});
  }
  return table({.title = "The pattern that was found", .span = Span::Half}, {"parameter", "value", "start", "bounds"},
               rows);
}

nlohmann::json history_chart(const RunResults& results) {
  std::vector<double> objectives;
  for (const auto& step : results.design.search.history) objectives.push_back(step.step.objective);
  return search_history(
      {.title = "Search history",
       .caption = fmt::format("{:.0f} evaluations; {}.", results.design.search.cost, results.design.search.outcome),
       .span = Span::Half},
      objectives, {}, "distance that the stage lowered");
}

nlohmann::json ellipse_chart(const RunResults& results) {
  return slope_ellipses(
      {.title = "Slopes", .caption = "One standard deviation of the slopes along x and y.", .span = Span::Half},
      {{"target", results.target.slopes, true},
       {"fresh draws", results.design.on_fresh_draws.axes},
       {"this print", results.printed_slopes}});
}

nlohmann::json covariance_table(const RunResults& results) {
  const double to_alpha = std::sqrt(2.0);
  const auto row = [&](const char* name, const SlopeAxesEstimate& e) {
    return TableRow{{name, Quantity{to_alpha * e.axes.rms_major, "1", to_alpha * e.rms_major_error},
                     Quantity{to_alpha * e.axes.rms_minor, "1", to_alpha * e.rms_minor_error},
                     Quantity{e.axes.rotation.degrees(), "°", e.rotation_error.degrees()}}};
  };
  const auto exact_row = [&](const char* name, const SlopeAxes& axes) {
    return TableRow{{name, Quantity{to_alpha * axes.rms_major, "1", {}}, Quantity{to_alpha * axes.rms_minor, "1", {}},
                     Quantity{axes.rotation.degrees(), "°", {}}}};
  };
  TableRow fresh = row("fresh draws", results.design.on_fresh_draws);
  fresh.outcome = results.design.met ? Outcome::Met : Outcome::Missed;
  return table({.title = "Slopes as Beckmann α", .span = Span::Half}, {"", "α_x", "α_y", "axis"},
               {exact_row("target", results.target.slopes), row("search draws", results.design.on_search_draws), fresh,
                exact_row("this print", results.printed_slopes)});
}

}  // namespace

Section design_section(const Experiment& experiment, const RunResults& results) {
  Section section{
      .title = "The design",
      .text = fmt::format(
          "`{}` changed the free parameters of the pattern until the {} of the *printed* relief matched: pattern, gray "
          "levels, spread of the light, cure curve and ground noise are all in the loop. The "
          "search saw the same {} random draws at every step; the result is judged on {} others.",
          experiment.search.minimize.algorithm,
          results.design.fresh_lobe_error ? "reflection maps (single reflection, cube-rooted)" : "slope covariance",
          experiment.search.draws, experiment.search.fresh_draws)};
  if (!experiment.pattern.reason.empty()) section.text += "\n\nPattern: " + experiment.pattern.reason + ".";
  section.components = {parameter_table(results), history_chart(results), ellipse_chart(results),
                        covariance_table(results)};
  return section;
}

}  // namespace mezzotint
