#include "experiments/report/charts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

using nlohmann::json;

json specification(json layers) {
  return {{"width", "container"}, {"height", "container"}, {"layer", std::move(layers)}};
}

json values(json rows) { return {{"values", std::move(rows)}}; }

json axis(const std::string& field, const std::string& title, bool logarithmic) {
  json out = {{"field", field}, {"type", "quantitative"}, {"title", title}, {"axis", {{"tickCount", 6}}}};
  out["scale"] =
      logarithmic ? json{{"type", "log"}, {"nice", false}, {"padding", 8}} : json{{"zero", false}, {"nice", true}};
  if (logarithmic) {
    out["axis"]["tickCount"] = 5;
    // Powers of ten that are not read at a glance.
    out["axis"]["labelExpr"] =
        "abs(log(datum.value) / LN10) < 3.5 ? format(datum.value, '~g') : replace(format(datum.value, '.0e'), '+', '')";
  }
  return out;
}

// The target has the colour of the text, whatever its place; the others take the page's series in turn.
struct Legend {
  json names = json::array();
  json colours = json::array();
  json dashes = json::array();
  int next = 1;

  void add(const std::string& name, bool target) {
    if (std::find(names.begin(), names.end(), json(name)) != names.end()) return;
    names.push_back(name);
    colours.push_back(target ? std::string("$ink") : "$series-" + std::to_string((next++ - 1) % 6 + 1));
    dashes.push_back(target ? json{5, 4} : json{1, 0});
  }
  [[nodiscard]] json shown() const {
    return names.size() > 1 ? json{{"symbolType", "stroke"}, {"symbolOpacity", 1}, {"symbolStrokeWidth", 2.5}}
                            : json(nullptr);
  }
  [[nodiscard]] json colour() const {
    return {{"field", "series"},
            {"type", "nominal"},
            {"legend", shown()},
            {"scale", {{"domain", names}, {"range", colours}}}};
  }
  [[nodiscard]] json dash() const {
    return {{"field", "series"},
            {"type", "nominal"},
            {"legend", shown()},
            {"scale", {{"domain", names}, {"range", dashes}}}};
  }
};

void require_whole(const Series& series) {
  require(series.x.size() == series.y.size(), "the series \"" + series.name + "\" must have as many x as y");
  require(series.standard_error.empty() || series.standard_error.size() == series.y.size(),
          "the series \"" + series.name + "\" must have one standard error a point, or none");
}

bool showable(double value, bool logarithmic) { return std::isfinite(value) && (!logarithmic || value > 0.0); }

void append_rows(json& rows, const Series& series, bool log_x, bool log_y) {
  require_whole(series);
  for (std::size_t k = 0; k < series.x.size(); ++k) {
    const double x = series.x[k], y = series.y[k];
    if (!showable(x, log_x) || !showable(y, log_y)) continue;
    json row = {{"series", series.name}, {"x", x}, {"y", y}};
    if (!series.standard_error.empty()) {
      const double error = series.standard_error[k];
      row["error"] = error;
      // On a logarithmic axis a band that reaches zero has no lower end; a tenth of the value stands for it.
      row["low"] = log_y ? std::max(y - error, 0.1 * y) : y - error;
      row["high"] = y + error;
    }
    rows.push_back(std::move(row));
  }
}

json line_layer(const Legend& legend, const json& x, const json& y) {
  return {{"mark", {{"type", "line"}, {"clip", true}}},
          {"encoding", {{"x", x}, {"y", y}, {"color", legend.colour()}, {"strokeDash", legend.dash()}}}};
}

json band_layer(const Legend& legend, const json& x, const json& y) {
  json low = y;
  low["field"] = "low";
  return {{"transform", {{{"filter", "isValid(datum.low)"}}}},
          {"mark", {{"type", "area"}, {"opacity", 0.18}, {"clip", true}}},
          {"encoding", {{"x", x}, {"y", low}, {"y2", {{"field", "high"}}}, {"color", legend.colour()}}}};
}

json tooltip(const ChartAxes& axes) {
  json out = {{{"field", "series"}, {"title", "Series"}},
              {{"field", "x"}, {"title", axes.x_title}, {"format", ".4~g"}},
              {{"field", "y"}, {"title", axes.y_title}, {"format", ".4~g"}}};
  return out;
}

json point_layer(const Legend& legend, const json& x, const json& y, const ChartAxes& axes, bool visible) {
  return {{"mark", {{"type", "point"}, {"filled", true}, {"size", 42}, {"opacity", visible ? 1 : 0}}},
          {"encoding", {{"x", x}, {"y", y}, {"color", legend.colour()}, {"tooltip", tooltip(axes)}}}};
}

// A line across the chart, with its name. Data of its own: it would be drawn once for each row of the chart's.
void add_tolerance(json& layers, double tolerance) {
  const json row = values({json{{"tolerance", tolerance}}});
  const json place = {{"y", {{"field", "tolerance"}, {"type", "quantitative"}}}};
  layers.push_back(
      {{"data", row}, {"mark", {{"type", "rule"}, {"color", "$met"}, {"strokeDash", {5, 4}}}}, {"encoding", place}});
  layers.push_back({{"data", row},
                    {"mark",
                     {{"type", "text"},
                      {"text", "tolerance"},
                      {"color", "$met"},
                      {"align", "left"},
                      {"baseline", "bottom"},
                      {"dy", -4},
                      {"x", 4}}},
                    {"encoding", place}});
}

Panel with_sentence(Panel panel, const std::string& sentence) {
  panel.caption += (panel.caption.empty() ? "" : " ") + sentence;
  return panel;
}

std::vector<std::array<double, 2>> ellipse_points(const SlopeAxes& axes) {
  constexpr int steps = 96;
  const double c = std::cos(axes.rotation.radians()), s = std::sin(axes.rotation.radians());
  std::vector<std::array<double, 2>> points;
  for (int k = 0; k <= steps; ++k) {
    const double t = 2.0 * std::numbers::pi * k / steps;
    const double u = axes.rms_major * std::cos(t), v = axes.rms_minor * std::sin(t);
    points.push_back({c * u - s * v, s * u + c * v});
  }
  return points;
}

json path_rows(const std::string& name, const std::vector<std::array<double, 2>>& points) {
  json rows = json::array();
  for (std::size_t k = 0; k < points.size(); ++k) {
    rows.push_back({{"series", name}, {"x", points[k][0]}, {"y", points[k][1]}, {"order", k}});
  }
  return rows;
}

json square_axis(const std::string& field, const std::string& title, double reach) {
  return {{"field", field},
          {"type", "quantitative"},
          {"title", title},
          {"axis", {{"tickCount", 5}, {"grid", true}}},
          {"scale", {{"domain", {-reach, reach}}, {"nice", false}}}};
}

json path_layer(const Legend& legend, const json& x, const json& y, json rows, double width) {
  return {{"data", values(std::move(rows))},
          {"mark", {{"type", "line"}, {"strokeWidth", width}}},
          {"encoding",
           {{"x", x},
            {"y", y},
            {"order", {{"field", "order"}, {"type", "quantitative"}}},
            {"color", legend.colour()},
            {"strokeDash", legend.dash()}}}};
}

json history_rows(const std::vector<double>& objectives) {
  json rows = json::array();
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < objectives.size(); ++k) {
    if (!showable(objectives[k], true)) continue;
    best = std::min(best, objectives[k]);
    rows.push_back({{"evaluation", k + 1}, {"objective", objectives[k]}, {"best", best}});
  }
  return rows;
}

}  // namespace

json line_chart(const Panel& panel, const ChartAxes& axes, const std::vector<Series>& series) {
  require(!series.empty(), "the chart \"" + panel.title + "\" needs at least one series");
  Legend legend;
  json rows = json::array();
  std::size_t longest = 0;
  bool banded = false;
  for (const Series& one : series) {
    legend.add(one.name, one.target);
    append_rows(rows, one, axes.log_x, axes.log_y);
    longest = std::max(longest, one.x.size());
    banded = banded || !one.standard_error.empty();
  }
  const json x = axis("x", axes.x_title, axes.log_x), y = axis("y", axes.y_title, axes.log_y);
  json layers = json::array();
  if (banded) layers.push_back(band_layer(legend, x, y));
  layers.push_back(line_layer(legend, x, y));
  layers.push_back(point_layer(legend, x, y, axes, longest <= 16));
  if (axes.tolerance) add_tolerance(layers, *axes.tolerance);
  json chart = specification(std::move(layers));
  chart["data"] = values(std::move(rows));
  return vega_lite_chart(banded ? with_sentence(panel, "Bands show ± 1 standard error.") : panel, std::move(chart));
}

json search_history(const Panel& panel, const std::vector<double>& objectives, std::optional<double> tolerance,
                    const std::string& objective_title) {
  const json x = {{"field", "evaluation"},
                  {"type", "quantitative"},
                  {"title", "Evaluation"},
                  {"scale", {{"nice", false}, {"zero", false}}},
                  {"axis", {{"tickCount", 6}}}};
  json y = axis("objective", objective_title, true), best = axis("best", objective_title, true);
  Legend legend;
  legend.add("best so far", false);
  json evaluated = {
      {"mark", {{"type", "point"}, {"filled", true}, {"size", 22}, {"color", "$quiet"}, {"opacity", 0.5}}},
      {"encoding",
       {{"x", x},
        {"y", y},
        {"tooltip",
         {{{"field", "evaluation"}},
          {{"field", "objective"}, {"format", ".4~g"}},
          {{"field", "best"}, {"title", "best so far"}, {"format", ".4~g"}}}}}}};
  json course = {
      {"mark", {{"type", "line"}, {"interpolate", "step-after"}, {"color", "$series-1"}, {"strokeWidth", 2.25}}},
      {"encoding", {{"x", x}, {"y", best}}}};
  json layers = {std::move(evaluated), std::move(course)};
  if (tolerance) add_tolerance(layers, *tolerance);
  json chart = specification(std::move(layers));
  chart["data"] = values(history_rows(objectives));
  return vega_lite_chart(with_sentence(panel, "Dots are evaluations; the line is the best so far."), std::move(chart));
}

json bar_chart(const Panel& panel, const std::string& y_title, const std::vector<Bar>& bars) {
  require(!bars.empty(), "the chart \"" + panel.title + "\" needs at least one bar");
  Legend legend;
  json rows = json::array(), categories = json::array();
  for (const Bar& bar : bars) {
    legend.add(bar.series, false);
    if (std::find(categories.begin(), categories.end(), json(bar.category)) == categories.end())
      categories.push_back(bar.category);
    rows.push_back({{"category", bar.category},
                    {"series", bar.series},
                    {"value", bar.value},
                    {"low", bar.value - bar.standard_error},
                    {"high", bar.value + bar.standard_error}});
  }
  const json x = {{"field", "category"},
                  {"type", "nominal"},
                  {"title", nullptr},
                  {"sort", categories},
                  {"axis", {{"labelAngle", 0}, {"ticks", false}}},
                  {"scale", {{"paddingInner", 0.35}}}};
  const json offset = {{"field", "series"}, {"sort", legend.names}};
  const json y = {{"field", "value"}, {"type", "quantitative"}, {"title", y_title}, {"axis", {{"tickCount", 5}}}};
  json colour = legend.colour();
  if (!colour["legend"].is_null()) colour["legend"] = {{"symbolType", "square"}, {"symbolOpacity", 1}};
  json low = y;
  low["field"] = "low";
  json filled = {{"mark", "bar"},
                 {"encoding",
                  {{"x", x},
                   {"xOffset", offset},
                   {"y", y},
                   {"color", colour},
                   {"tooltip", {{{"field", "series"}}, {{"field", "value"}, {"format", ".4~g"}}}}}}};
  json whiskers = {{"mark", {{"type", "rule"}, {"color", "$ink"}, {"strokeWidth", 1.5}}},
                   {"encoding", {{"x", x}, {"xOffset", offset}, {"y", low}, {"y2", {{"field", "high"}}}}}};
  json chart = specification({std::move(filled), std::move(whiskers)});
  chart["data"] = values(std::move(rows));
  return vega_lite_chart(with_sentence(panel, "Whiskers show ± 1 standard error."), std::move(chart));
}

json slope_histogram(const Panel& panel, const Histogram& histogram, const std::vector<Series>& references,
                     const std::string& x_title) {
  require(!histogram.density.empty() && histogram.edges.size() == histogram.density.size() + 1,
          "the histogram \"" + histogram.name + "\" must have one edge more than densities");
  Legend legend;
  legend.add(histogram.name, false);
  json steps = json::array(), curves = json::array();
  for (std::size_t k = 0; k < histogram.density.size(); ++k) {
    steps.push_back({{"series", histogram.name},
                     {"x", histogram.edges[k]},
                     {"x2", histogram.edges[k + 1]},
                     {"y", histogram.density[k]}});
  }
  for (const Series& reference : references) {
    legend.add(reference.name, reference.target);
    append_rows(curves, reference, false, false);
  }
  json x = axis("x", x_title, false);
  x["scale"] = {{"nice", false}, {"zero", false}};
  json y = axis("y", "Probability density", false);
  y["scale"] = {{"zero", true}};
  json bars = {{"data", values(std::move(steps))},
               {"mark", {{"type", "bar"}, {"opacity", 0.45}, {"cornerRadiusEnd", 0}, {"binSpacing", 0}}},
               {"encoding",
                {{"x", x}, {"x2", {{"field", "x2"}}}, {"y", y}, {"y2", {{"datum", 0}}}, {"color", legend.colour()}}}};
  json lines = line_layer(legend, x, y);
  lines["data"] = values(std::move(curves));
  return vega_lite_chart(panel, specification({std::move(bars), std::move(lines)}));
}

json slope_ellipses(const Panel& panel, const std::vector<NamedAxes>& covariances) {
  require(!covariances.empty(), "the chart \"" + panel.title + "\" needs at least one covariance");
  Legend legend;
  json outlines = json::array(), long_axes = json::array();
  double reach = 0.0;
  for (const NamedAxes& one : covariances) {
    legend.add(one.name, one.target);
    for (json& row : path_rows(one.name, ellipse_points(one.axes))) outlines.push_back(std::move(row));
    const double x = one.axes.rms_major * std::cos(one.axes.rotation.radians());
    const double y = one.axes.rms_major * std::sin(one.axes.rotation.radians());
    for (json& row : path_rows(one.name, {{-x, -y}, {x, y}})) long_axes.push_back(std::move(row));
    reach = std::max(reach, 1.15 * one.axes.rms_major);
  }
  const json x = square_axis("x", "RMS slope along x", reach), y = square_axis("y", "RMS slope along y", reach);
  json chart = specification(
      {path_layer(legend, x, y, std::move(outlines), 2.25), path_layer(legend, x, y, std::move(long_axes), 1.0)});
  chart["width"] = chart["height"] = 300;  // a circle must look like one
  return vega_lite_chart(panel, std::move(chart));
}

}  // namespace mezzotint
