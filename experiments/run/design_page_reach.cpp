#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "experiments/report/components.h"
#include "experiments/run/design_page.h"
#include "inverse/objective/lobe_distance.h"

namespace mezzotint {

namespace {

using nlohmann::json;

const double to_alpha = std::sqrt(2.0);

json axis(const char* field, const char* title, double low, double high) {
  return {{"field", field},
          {"type", "quantitative"},
          {"title", title},
          {"axis", {{"format", "~g"}, {"tickCount", 5}}},
          {"scale", {{"type", "log"}, {"domain", {low, high}}, {"nice", false}}}};
}

struct Mark {
  std::string name;
  double x, y;
};

std::vector<Mark> marks_of(const DesignResults& results) {
  const auto& gamut = results.json.at("gamut");
  std::vector<Mark> marks = {{"target", gamut.at("target").at("alpha_x"), gamut.at("target").at("alpha_y")}};
  if (gamut.at("place") == "outside") {
    const auto& nearest = gamut.at("verdict").at("nearest");
    marks.push_back({"nearest in reach", nearest.at("alpha_x").at("value"), nearest.at("alpha_y").at("value")});
  }
  if (results.design) {
    const SlopeAxes& found = results.design->on_fresh_draws.axes;
    marks.push_back({"found", to_alpha * found.rms_major, to_alpha * found.rms_minor});
  } else {
    for (const auto& print : results.json.at("blur").at("prints")) {
      if (print.at("factor") == 1.0)
        marks.push_back({"found", print.at("alpha_x").at("value"), print.at("alpha_y").at("value")});
    }
  }
  return marks;
}

// Above the floor and below the diagonal, as far as a sinusoid on both axes and a wave along one let it.
json reach_chart(const DesignResults& results) {
  const auto& formula = results.json.at("gamut").at("formula");
  const auto value = [&](const char* name) { return formula.at(name).at("value").get<double>(); };
  const double floor = value("floor_alpha"), both = value("largest_alpha_on_both_axes"),
               one = value("largest_alpha_on_one_axis");
  double low = floor, high = std::max(one, both);
  json rows = json::array();
  for (const Mark& mark : marks_of(results)) {
    rows.push_back({{"name", mark.name}, {"alpha_x", mark.x}, {"alpha_y", mark.y}});
    low = std::min(low, mark.y);
    high = std::max(high, mark.x);
  }
  low /= 1.5;
  high *= 1.3;
  const json x = axis("alpha_x", "α_x, along the steeper axis", low, high), y = axis("alpha_y", "α_y", low, high);
  json outline = json::array();
  int order = 0;
  for (const auto& [ax, ay] : {std::pair{floor, floor}, {one, floor}, {both, both}, {floor, floor}})
    outline.push_back({{"alpha_x", ax}, {"alpha_y", ay}, {"order", order++}});
  const json floor_line = {{"data", {{"values", json::array({{{"alpha_y", floor}}})}}},
                           {"mark", {{"type", "rule"}, {"color", "$quiet"}, {"strokeDash", {5, 4}}}},
                           {"encoding", {{"y", y}}}};
  const json diagonal = {
      {"data", {{"values", {{{"alpha_x", low}, {"alpha_y", low}}, {{"alpha_x", high}, {"alpha_y", high}}}}}},
      {"mark", {{"type", "line"}, {"color", "$quiet"}, {"strokeDash", {2, 3}}}},
      {"encoding", {{"x", x}, {"y", y}}}};
  const json border = {{"data", {{"values", outline}}},
                       {"mark", {{"type", "line"}, {"color", "$series-1"}, {"strokeWidth", 2}}},
                       {"encoding", {{"x", x}, {"y", y}, {"order", {{"field", "order"}}}}}};
  const json points = {
      {"data", {{"values", rows}}},
      {"mark", {{"type", "point"}, {"size", 140}, {"strokeWidth", 2.6}}},
      {"encoding",
       {{"x", x},
        {"y", y},
        {"shape",
         {{"field", "name"},
          {"type", "nominal"},
          {"title", nullptr},
          {"scale", {{"domain", {"target", "nearest in reach", "found"}}, {"range", {"circle", "diamond", "cross"}}}}}},
        {"color",
         {{"field", "name"},
          {"type", "nominal"},
          {"title", nullptr},
          {"scale",
           {{"domain", {"target", "nearest in reach", "found"}}, {"range", {"$ink", "$quiet", "$series-2"}}}}}},
        {"tooltip",
         {{{"field", "name"}},
          {{"field", "alpha_x"}, {"format", ".3g"}},
          {{"field", "alpha_y"}, {"format", ".3g"}}}}}}};
  return vega_lite_chart(
      {.title = "Target and design among what the printer can do",
       .caption = "The line is the one-line formula's estimate: floor of the ground, steepest wave along one axis, "
                  "steepest on both. Dashed: no print is smoother. Dotted: round lobes.",
       .span = Span::TwoThirds},
      {{"width", "container"}, {"height", 340}, {"layer", {border, floor_line, diagonal, points}}});
}

Quantity quantity(const Estimate& estimate) { return {estimate.value, "1", estimate.standard_error}; }

std::string in_degrees(const DirectionAngles& light) {
  return fmt::format("light from θ = {:.0f}°, φ = {:.0f}°", light.theta.degrees(), light.phi.degrees());
}

json residual_table(const DesignResults& results) {
  const LobeJudgement* searched = nullptr;
  const LobeJudgement* fresh = nullptr;
  if (results.design) {
    if (results.design->on_search_lobes) searched = &*results.design->on_search_lobes;
    if (results.design->on_fresh_lobes) fresh = &*results.design->on_fresh_lobes;
  } else {
    fresh = &results.traced->by_slope;
  }
  const LobeJudgement* traced = results.traced ? &results.traced->traced : nullptr;
  std::vector<TableRow> rows;
  for (const LobeDistance distance : all_lobe_distances) {
    TableRow row{{std::string(root_name_of(distance))}};
    for (const LobeJudgement* judgement : {searched, fresh, traced}) {
      row.cells.push_back(judgement ? json(quantity(judgement->by(distance).root)) : json("–"));
      if (judgement != searched)
        row.cells.push_back(judgement ? json(Quantity{judgement->by(distance).root_floor, "1", {}}) : json("–"));
    }
    rows.push_back(row);
  }
  return table(
      {.title = "How far the lobes are from the target",
       .caption = "Roots of the distances, means over the directions of the light, with standard errors over "
                  "the draws. *Floor*: what the noise of so few draws gives by itself; a distance there may be "
                  "better than it reads. *Traced* counts."},
      {"", "search draws", "fresh draws", "floor", "traced", "floor"}, rows);
}

json lobe_maps(const DesignResults& results, std::size_t light) {
  const Bsdf& wanted = results.wanted[light];
  const Bsdf& shown = results.predicted[light];
  NamedMap target{.name = "target", .grid = wanted.grid, .mean = wanted.reflection.mean, .incidence = wanted.incidence};
  target.target = true;
  const NamedMap predicted = named_map("predicted (traced)", shown.grid, shown.reflection, shown.incidence);
  return direction_maps({.title = in_degrees(shown.incidence)},
                        {target, predicted, difference_map("predicted − target", predicted, target)});
}

}  // namespace

Section reach_section(const DesignResults& results) {
  const auto& gamut = results.json.at("gamut");
  Section section{.title = "Within reach, or not"};
  section.text =
      fmt::format("{}.\n\nBefore anything is searched, the printer's profile says: {}.",
                  gamut.at("in_words").get<std::string>(), gamut.at("formula").at("in_words").get<std::string>());
  section.components = {reach_chart(results)};
  return section;
}

Section residual_section(const DesignResults& results) {
  Section section{.title = "What is left"};
  section.text =
      "The design was printed anew on draws that the search never saw, rounded to the printer's gray levels, and "
      "traced through its full relief.";
  if (results.traced)
    section.components.push_back(residual_table(results));
  else
    section.text +=
        "\n\nThe target names no lobe; the prediction stands beside the Beckmann lobe of the target's slopes.";
  for (std::size_t light = 0; light < std::min(results.wanted.size(), results.predicted.size()); ++light)
    section.components.push_back(lobe_maps(results, light));
  return section;
}

}  // namespace mezzotint
