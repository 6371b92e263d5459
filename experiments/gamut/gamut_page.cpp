#include "experiments/gamut/gamut_page.h"

#include <algorithm>

#include <fmt/format.h>

#include "experiments/gamut/gamut_axes.h"
#include "experiments/report/components.h"

namespace mezzotint {

namespace {

using nlohmann::json;

constexpr double chart_height = 460.0;

json axis(const char* field, const char* title, double low, double high) {
  return {{"field", field},
          {"type", "quantitative"},
          {"title", title},
          {"axis", {{"format", "~g"}, {"grid", true}, {"values", ticks(low, high)}}},
          {"scale", {{"type", "log"}, {"domain", {low, high}}, {"nice", false}}}};
}

struct Layers {
  AlphaAxes axes;
  json x, y, colour;

  explicit Layers(const GamutFindings& findings)
      : axes(axes_of(findings)),
        x(axis("alpha_x", "α along the steeper axis", axes.low_x, axes.high_x)),
        y(axis("alpha_y", "α across it", axes.low_y, axes.high_y)) {
    json names = json::array(), colours = json::array();
    for (const std::string& kind : findings.map.options.kinds) {
      names.push_back(kind);
      colours.push_back(colour_of(kind));
    }
    colour = {{"field", "kind"},
              {"type", "nominal"},
              {"title", "Pattern"},
              {"legend", {{"symbolType", "stroke"}, {"symbolStrokeWidth", 2.5}}},
              {"scale", {{"domain", names}, {"range", colours}}}};
  }

  // Below the ground's floor, and beyond a ratio of 1: for no printer and no pattern.
  [[nodiscard]] json unreachable(double floor) const {
    json low = y, band = {{"alpha_y", axes.low_y}, {"floor", floor}};
    return {{"data", {{"values", json::array({band})}}},
            {"mark", {{"type", "rect"}, {"color", "$quiet"}, {"opacity", 0.16}}},
            {"encoding", {{"y", low}, {"y2", {{"field", "floor"}}}}}};
  }
  [[nodiscard]] json diagonal() const {
    const double from = std::max(axes.low_x, axes.low_y), to = std::min(axes.high_x, axes.high_y);
    const json rows = json::array({{{"alpha_x", from}, {"alpha_y", from}}, {{"alpha_x", to}, {"alpha_y", to}}});
    return {{"data", {{"values", rows}}},
            {"mark", {{"type", "line"}, {"color", "$quiet"}, {"strokeDash", {2, 3}}, {"strokeWidth", 1.2}}},
            {"encoding", {{"x", x}, {"y", y}}}};
  }
  [[nodiscard]] json outlines() const {
    return {{"mark", {{"type", "line"}, {"strokeWidth", 2.25}, {"strokeJoin", "round"}}},
            {"encoding", {{"x", x}, {"y", y}, {"color", colour}, {"order", {{"field", "order"}}}}}};
  }
  [[nodiscard]] json points() const {
    return {{"transform", {{{"filter", "isValid(datum.tolerance)"}}}},
            {"mark", {{"type", "point"}, {"filled", true}, {"size", 24}, {"opacity", 1}}},
            {"encoding",
             {{"x", x},
              {"y", y},
              {"color", colour},
              {"tooltip",
               {{{"field", "kind"}},
                {{"field", "alpha_x"}, {"format", ".3g"}},
                {{"field", "alpha_y"}, {"format", ".3g"}},
                {{"field", "tolerance"}, {"title", "relative tolerance"}, {"format", ".2g"}}}}}}};
  }
};

void add_outline(json& rows, const GamutRegion& region) {
  int order = 0;
  const auto add = [&](const AlphaPair& alpha, const json& tolerance) {
    rows.push_back({{"kind", region.kind},
                    {"blur", region.blur_factor},
                    {"alpha_x", alpha.x},
                    {"alpha_y", alpha.y},
                    {"tolerance", tolerance},
                    {"order", order++}});
  };
  add({region.floor_alpha, region.floor_alpha}, nullptr);
  for (const BorderPoint& point : region.stretched) add(point.alpha, point.tolerance);
  for (const BorderPoint& point : region.steepest) add(point.alpha, point.tolerance);
  add({region.floor_alpha, region.floor_alpha}, nullptr);
}

// Asked targets as marks, with lines to the nearest prints.
void add_targets(json& layers, const GamutFindings& findings, const Layers& parts) {
  json marks = json::array(), arrows = json::array();
  for (const AskedTarget& target : findings.targets) {
    const AlphaPair& nearest = target.best().nearest;
    marks.push_back({{"alpha_x", target.alpha.x},
                     {"alpha_y", target.alpha.y},
                     {"answer", target.is_reached() ? "can be printed" : "cannot be printed"},
                     {"why", target.best().why}});
    if (target.is_reached()) continue;
    arrows.push_back(
        {{"alpha_x", target.alpha.x}, {"alpha_y", target.alpha.y}, {"nearest_x", nearest.x}, {"nearest_y", nearest.y}});
  }
  const json tip = {{{"field", "answer"}}, {{"field", "why"}}, {{"field", "alpha_x"}}, {{"field", "alpha_y"}}};
  json end_x = parts.x, end_y = parts.y;
  end_x["field"] = "nearest_x";
  end_y["field"] = "nearest_y";
  layers.push_back(
      {{"data", {{"values", arrows}}},
       {"mark", {{"type", "rule"}, {"color", "$ink"}, {"strokeWidth", 1.4}}},
       {"encoding",
        {{"x", parts.x}, {"y", parts.y}, {"x2", {{"field", "nearest_x"}}}, {"y2", {{"field", "nearest_y"}}}}}});
  layers.push_back(
      {{"data", {{"values", arrows}}},
       {"mark", {{"type", "point"}, {"shape", "diamond"}, {"filled", true}, {"size", 70}, {"color", "$ink"}}},
       {"encoding", {{"x", end_x}, {"y", end_y}}}});
  layers.push_back(
      {{"data", {{"values", marks}}},
       {"mark", {{"type", "point"}, {"filled", false}, {"size", 130}, {"strokeWidth", 2.6}}},
       {"encoding",
        {{"x", parts.x},
         {"y", parts.y},
         {"shape",
          {{"field", "answer"},
           {"type", "nominal"},
           {"title", "Asked"},
           {"scale", {{"domain", {"can be printed", "cannot be printed"}}, {"range", {"circle", "cross"}}}}}},
         {"color", {{"value", "$ink"}}},
         {"tooltip", tip}}}});
}

json overview(const GamutFindings& findings) {
  const Layers parts(findings);
  json rows = json::array();
  for (const GamutRegion& region : findings.map.regions)
    if (region.blur_factor == 1.0) add_outline(rows, region);
  json layers = {parts.unreachable(findings.map.formula.floor_alpha), parts.diagonal(), parts.outlines(),
                 parts.points()};
  if (!findings.targets.empty()) add_targets(layers, findings, parts);
  return vega_lite_chart(
      {.title = "What can be printed",
       .caption = "Every kind reaches what its line encloses, from the ground's floor (gray) to the diagonal of round "
                  "lobes. Points were printed by the process model; hover for their tolerance. A line from a target "
                  "that cannot be printed leads to the nearest print."},
      {{"data", {{"values", rows}}}, {"width", "container"}, {"height", chart_height}, {"layer", layers}});
}

json by_blur(const GamutFindings& findings) {
  const Layers parts(findings);
  json rows = json::array();
  for (const GamutRegion& region : findings.map.regions) add_outline(rows, region);
  json lines = parts.outlines();
  lines["encoding"]["color"]["legend"] = nullptr;
  lines["encoding"]["strokeDash"] = {
      {"field", "blur"},
      {"type", "ordinal"},
      {"title", "Times the profile's blur"},
      {"legend", {{"symbolType", "stroke"}, {"symbolStrokeWidth", 2.5}}},
      {"scale", {{"domain", findings.map.options.blur_factors}, {"range", {{1, 0}, {7, 4}, {2, 3}, {9, 3, 2, 3}}}}}};
  const json choice = {{"name", "pattern"},
                       {"value", findings.map.options.kinds.front()},
                       {"bind", {{"input", "select"}, {"options", findings.map.options.kinds}, {"name", "Pattern: "}}}};
  return vega_lite_chart(
      {.title = "The blur decides", .caption = "The border of one kind, at the profile's blur and at others."},
      {{"params", {choice}},
       {"data", {{"values", rows}}},
       {"transform", {{{"filter", "datum.kind == pattern"}}}},
       {"width", "container"},
       {"height", chart_height},
       {"layer", {parts.unreachable(findings.map.formula.floor_alpha), parts.diagonal(), lines}}});
}

// A row a target: the kind that reaches it best, or comes nearest.
json target_table(const GamutFindings& findings) {
  std::vector<TableRow> rows;
  for (const AskedTarget& target : findings.targets) {
    const GamutVerdict& best = target.best();
    std::string kinds;
    for (const GamutVerdict& verdict : target.verdicts)
      if (verdict.place != GamutPlace::Outside) kinds += (kinds.empty() ? "" : ", ") + verdict.kind;
    rows.push_back({{in_words(target.alpha), kinds.empty() ? "none" : kinds, best.why, in_words(best.nearest),
                     parameters_in_words(best.pattern)},
                    target.is_reached() ? Outcome::Met : Outcome::Missed});
  }
  return table(
      {.title = "Asked targets",
       .caption = "*Nearest* in the logarithms of the slope covariance. `gamut.json` has every kind's verdict."},
      {"α_x, α_y", "Printed by", "Why", "Nearest", "Its parameters"}, rows);
}

json kind_table(const GamutFindings& findings) {
  std::vector<TableRow> rows;
  for (const GamutRegion& region : findings.map.regions) {
    const BorderPoint& steepest =
        *std::ranges::max_element(region.steepest, {}, [](const BorderPoint& point) { return point.alpha.x; });
    const BorderPoint& roundest =
        *std::ranges::max_element(region.steepest, {}, [](const BorderPoint& point) { return point.alpha.y; });
    double ratio = 1.0;
    for (const AlphaPair& alpha : region.outline()) ratio = std::max(ratio, alpha.x / alpha.y);
    rows.push_back(
        {{region.kind, region.blur_factor, Quantity{steepest.alpha.x, "1", steepest.tolerance * steepest.alpha.x},
          Quantity{roundest.alpha.y, "1", roundest.tolerance * roundest.alpha.y}, ratio,
          100.0 * region.largest_tolerance()}});
  }
  return table({.title = "Extremes"},
               {"Pattern", "Times the blur", "Largest α_x", "Largest α_y", "Largest α_x/α_y", "Tolerance up to (%)"},
               rows);
}

Verdict verdict_of(const GamutFindings& findings) {
  if (findings.targets.empty()) return {Outcome::Information, in_words(findings.map.formula)};
  const auto reached = std::ranges::count_if(findings.targets, &AskedTarget::is_reached);
  const bool all = reached == static_cast<std::ptrdiff_t>(findings.targets.size());
  return {all ? Outcome::Met : Outcome::Missed,
          fmt::format("{} of {} asked targets can be printed.", reached, findings.targets.size())};
}

void add_messages(Report& page, const PrinterProfile& printer) {
  if (!printer.spread.calibrated)
    page.messages.push_back(
        {MessageLevel::Warning,
         fmt::format("The blur of {:.3g} µm is assumed, not calibrated: it decides the gamut more than anything else; "
                     "see how far the borders move with it.",
                     printer.spread.width.um())});
  if (!printer.ground_is_calibrated)
    page.messages.push_back(
        {MessageLevel::Note, fmt::format("The ground's amplitude of {:.3g} µm is assumed: the floor grows with it.",
                                         printer.ground_amplitude.um())});
}

std::vector<KeyFigure> figures_of(const GamutFormula& formula) {
  std::vector<KeyFigure> figures;
  const auto add = [&](const char* name, double value, const char* note) {
    figures.push_back({.name = name, .quantity = Quantity{value, "1", {}}, .note = note});
  };
  add("Floor", formula.floor_alpha, "least α: the ground's slopes");
  add("Round lobes up to", formula.largest_alpha, "α, by the formula");
  add("Along one axis up to", formula.largest_alpha_one_axis, "α, by the formula");
  add("Unscattered", formula.coherent_share, "by the ground's finest octaves");
  return figures;
}

}  // namespace

Report gamut_page(const GamutFindings& findings) {
  const GamutMapOptions& options = findings.map.options;
  Report page{
      .title = "What " + findings.printer.name + " can print",
      .subtitle = fmt::format("Wavelengths and cells from {:.3g} pixels to {:.3g} µm, light of {:.4g} nm.",
                              options.bounds.least_pixels, options.bounds.longest.um(), 1e3 * options.wavelength.um()),
      .verdict = verdict_of(findings),
      .key_figures = figures_of(findings.map.formula)};
  add_messages(page, findings.printer);
  page.sections.push_back({"Before anything is printed", in_words(findings.map.formula) + ".", {}});
  if (!findings.targets.empty()) page.sections.push_back({"Asked", "", {target_table(findings)}});
  page.sections.push_back({"Chart", "α = √2 · RMS slope along the axes of the printed relief.", {overview(findings)}});
  page.sections.push_back({"Blur", "", {by_blur(findings), kind_table(findings)}});
  page.provenance["printer"] = findings.printer.name;
  page.provenance["patch"] = fmt::format("{}² pixels, {}² samples a pixel, {} draws, seed {}", options.patch.pixels,
                                         options.patch.subsamples, options.patch.draws, options.patch.seed);
  return page;
}

}  // namespace mezzotint
