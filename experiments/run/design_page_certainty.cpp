#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/report/components.h"
#include "experiments/run/design_answer.h"
#include "experiments/run/design_page.h"
#include "forward/pattern/pattern_parameters.h"

namespace mezzotint {

namespace {

std::string unit_of(std::string_view parameter) {
  if (parameter.ends_with("_um")) return "µm";
  return parameter.ends_with("_deg") ? "°" : "1";
}

// In the variable's own unit; by factors where it is logarithmic.
std::string interval_in_words(const Variable& variable, double value, double half_width) {
  if (!std::isfinite(half_width)) return "not determined by itself";
  if (variable.logarithmic)
    return fmt::format("{:.4g} … {:.4g}", value * std::exp(-half_width), value * std::exp(half_width));
  const double half = variable.name.ends_with("_deg") ? half_width * 180.0 / std::numbers::pi : half_width;
  return fmt::format("{:.4g} … {:.4g}", value - half, value + half);
}

nlohmann::json parameter_table(const Design& design) {
  std::vector<TableRow> rows;
  for (const auto& parameter : all_parameters(design.pattern)) {
    if (parameter.drawn) continue;
    const double value = get_parameter(design.pattern, parameter.name);
    const auto found = std::ranges::find(design.variables, parameter.name, &Variable::name);
    const bool is_free = found != design.variables.end();
    const auto index = static_cast<std::size_t>(found - design.variables.begin());
    const bool has_interval = is_free && index < design.intervals.half_widths_95.size();
    rows.push_back({{parameter.name, Quantity{value, unit_of(parameter.name), {}},
                     has_interval ? interval_in_words(*found, value, design.intervals.half_widths_95[index]) : "–",
                     is_free ? fmt::format("{:.4g}", found->start) : "–",
                     is_free ? fmt::format("{:g} … {:g}", found->low, found->high) : "fixed"}});
  }
  return table({.title = "The pattern that was found",
                .caption = "Intervals: 95 %, from the scatter of the search's draws. An error of the printer's profile "
                           "is not in them."},
               {"parameter", "value", "95 % interval", "start", "bounds"}, rows);
}

nlohmann::json combination_table(const Design& design) {
  std::vector<TableRow> rows;
  for (const ParameterCombination& c : design.intervals.combinations) {
    rows.push_back({{together_in_words(c, design.variables), in_words(c, design.variables),
                     c.determined ? fmt::format("± {:.2g}", c.half_width_95) : "–",
                     c.determined ? "determined" : "the target does not tell them apart"}});
  }
  return table(
      {.title = "What the target determines",
       .caption = "Directions in the space of the free parameters, the best determined first; 95 % half widths "
                  "along them, in logarithms (radians for angles)."},
      {"combination", "by", "95 %", ""}, rows);
}

std::string symmetry_in_words(const DesignResults& results) {
  const AxisSwap swap = axis_swap(*results.design);
  std::string text =
      "Turned by 180°, every design has the same slope covariance: a search by slopes cannot tell the two. ";
  if (!swap.is_free) return text + "No direction of the pattern was free, so a turn by 90° was not tried.";
  if (!swap.was_tried)
    return text + "The closed form led to the target at once: no scan was made, and a turn by 90° was not tried.";
  return text + fmt::format("Turned by 90°, the best place of the scan was {:.3g} times as far from the target.",
                            swap.worse_by);
}

}  // namespace

std::string together_in_words(const ParameterCombination& combination, const std::vector<Variable>& variables) {
  double largest = 0.0;
  for (const double change : combination.change) largest = std::max(largest, std::abs(change));
  std::vector<std::string> grow, shrink;
  double first = 0.0;
  for (std::size_t i = 0; i < variables.size(); ++i) {
    const double change = combination.change[i];
    if (std::abs(change) < 0.3 * largest) continue;
    if (first == 0.0) first = change;
    (change * first > 0.0 ? grow : shrink).push_back(variables[i].name);
  }
  const auto list = [](const std::vector<std::string>& names) { return fmt::format("{}", fmt::join(names, " and ")); };
  if (shrink.empty()) return grow.size() == 1 ? list(grow) + " by itself" : list(grow) + " grow together";
  return fmt::format("{} {} while {} {}", list(grow), grow.size() == 1 ? "grows" : "grow", list(shrink),
                     shrink.size() == 1 ? "shrinks" : "shrink");
}

Section certainty_section(const DesignResults& results) {
  const Design& design = *results.design;
  Section section{.title = "How sure it is", .text = symmetry_in_words(results)};
  section.text += fmt::format(
      "\n\nOn draws that the search never saw, the root of what it lowered is {:.2f} times that on its own{}.",
      design.held_out_ratio,
      design.held_out_ratio > 1.3 ? "; above 1.3 the search fitted its draws, so give it more of them" : "");
  section.components = {parameter_table(design)};
  if (!design.intervals.combinations.empty()) {
    std::string unseen;
    for (const ParameterCombination& c : design.intervals.combinations)
      if (!c.determined)
        unseen += "\n\n" + together_in_words(c, design.variables) + ": the target does not tell them apart.";
    section.text += unseen;
    section.components.push_back(combination_table(design));
  } else {
    section.text += "\n\nIntervals need three search draws or more; this search had fewer.";
  }
  return section;
}

}  // namespace mezzotint
