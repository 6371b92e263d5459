#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "experiments/report/charts.h"
#include "experiments/report/components.h"
#include "experiments/run/design_answer.h"
#include "experiments/run/design_page.h"

namespace mezzotint {

namespace {

using nlohmann::json;

// "coarse 1", "coarse 2" are one stage of the ladder.
std::string rung_of(const std::string& stage) { return stage.substr(0, stage.find(' ')); }

json course_chart(const Design& design) {
  json rows = json::array(), rungs = json::array(), colours = json::array();
  double cost = 0.0;
  for (const DesignStep& step : design.search.history) {
    cost += step.cost;
    const std::string rung = rung_of(step.stage);
    if (std::find(rungs.begin(), rungs.end(), json(rung)) == rungs.end()) {
      colours.push_back(fmt::format("$series-{}", rungs.size() % 6 + 1));
      rungs.push_back(rung);
    }
    if (!std::isfinite(step.step.objective) || step.step.objective <= 0.0) continue;
    rows.push_back(
        {{"cost", cost}, {"distance", std::sqrt(step.step.objective)}, {"stage", step.stage}, {"rung", rung}});
  }
  const json spec = {
      {"data", {{"values", rows}}},
      {"width", "container"},
      {"height", 320},
      {"mark", {{"type", "point"}, {"filled", true}, {"size", 36}, {"opacity", 0.8}}},
      {"encoding",
       {{"x", {{"field", "cost"}, {"type", "quantitative"}, {"title", "Cost, in evaluations on all draws"}}},
        {"y",
         {{"field", "distance"},
          {"type", "quantitative"},
          {"title", "Distance that the stage lowered (root)"},
          {"axis", {{"format", "~g"}, {"tickCount", 5}}},
          {"scale", {{"type", "log"}, {"nice", false}, {"padding", 8}}}}},
        {"color",
         {{"field", "rung"},
          {"type", "nominal"},
          {"title", "Stage"},
          {"sort", nullptr},
          {"scale", {{"domain", rungs}, {"range", colours}}}}},
        {"tooltip",
         {{{"field", "stage"}},
          {{"field", "cost"}, {"format", ".4~g"}},
          {{"field", "distance"}, {"format", ".4~g"}}}}}}};
  return vega_lite_chart(
      {.title = "Search history",
       .caption = "Every stage lowers its own distance, on its own number of draws: points of different colours do not "
                  "compare."},
      spec);
}

json blur_table(const json& prints, bool is_free_form) {
  std::vector<TableRow> rows;
  const auto quantity = [](const json& q) {
    Quantity read{q.at("value").is_null() ? std::nan("") : q.at("value").get<double>(), q.at("unit"), {}};
    if (q.contains("standard_error") && q["standard_error"].is_number())
      read.standard_error = q["standard_error"].get<double>();
    return read;
  };
  for (const json& print : prints) {
    rows.push_back({{fmt::format("× {:g}", print.at("factor").get<double>()), quantity(print.at("width")),
                     quantity(print.at("alpha_x")), quantity(print.at("alpha_y")),
                     Quantity{std::sqrt(print.at("lowered").get<double>()), "1", {}}}});
  }
  return table({.title = "The same gray layer with another blur",
                .caption = "The same draws, grounds and places in every row: only the blur differs."},
               {"blur", "width", "α_x", "α_y", is_free_form ? "cube_root_error, by slopes" : "distance lowered (root)"},
               rows);
}

}  // namespace

Section course_section(const DesignResults& results) {
  Section section{.title = "The search"};
  if (results.design) {
    std::string lowered;
    for (const WeightedMeasure& term : results.design->search.lowered)
      lowered += fmt::format("{}{:g} × `{}`", lowered.empty() ? "" : " + ", term.weight, name_of(term.measure));
    section.text = fmt::format("{:.0f} evaluations; {}. The last stage lowered {}.", results.design->search.cost,
                               results.design->search.outcome, lowered);
    section.components = {course_chart(*results.design)};
    return section;
  }
  const auto& free_form = results.json.at("free_form");
  section.text = fmt::format(
      "{} evaluations of all starts; the best grew from *{}*. Places of the samples change from "
      "epoch to epoch, and the objective with them.",
      free_form.at("evaluations").get<int>(), free_form.at("start").get<std::string>());
  section.components = {search_history({.title = "Search history"}, free_form.at("history").get<std::vector<double>>(),
                                       {}, "objective of the epoch")};
  return section;
}

Section layer_section(const DesignResults& results) {
  const auto& gray = results.json.at("gray");
  Section section{.title = "The layer"};
  const auto used = gray.at("levels_used").get<std::size_t>();
  section.text = fmt::format("`gray.png` has {} × {} pixels and uses {} of the printer's {} gray levels{}.",
                             gray.at("columns").get<std::size_t>(), gray.at("rows").get<std::size_t>(), used,
                             gray.at("printer_levels").get<int>(),
                             used < least_gray_levels
                                 ? fmt::format(" — fewer than {}: their steps show in the slopes", least_gray_levels)
                                 : "");
  if (results.json.contains("shortest_length_px") && results.json["shortest_length_px"].is_number()) {
    const double pixels = results.json["shortest_length_px"];
    section.text += fmt::format(" The pattern's shortest wavelength or cell is {:.1f} pixels{}.", pixels,
                                pixels < least_wavelength_px
                                    ? fmt::format(" — below {:g} the pixel grid shapes the relief", least_wavelength_px)
                                    : "");
  }
  section.components = {relief_maps({.title = "Predicted relief"}, {{"predicted", results.relief}})};
  return section;
}

Section blur_section(const DesignResults& results) {
  const auto& blur = results.json.at("blur");
  Section section{.title = "How much hangs on the blur"};
  section.text =
      fmt::format("Assumed is a {} spread of {:.2f} µm, {}.", blur.at("kernel").get<std::string>(),
                  blur.at("width").at("value").get<double>(),
                  blur.at("calibrated").get<bool>() ? "calibrated" : "**not calibrated**: print a ramp and measure it");
  section.components = {blur_table(blur.at("prints"), !results.design)};
  return section;
}

}  // namespace mezzotint
