#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "experiments/report/components.h"
#include "experiments/texture/texture_charts.h"
#include "measurement/texture/bearing_curve.h"

namespace mezzotint {

namespace {

using nlohmann::json;

json channel(const std::string& field, const std::string& title) {
  return {{"field", field},
          {"type", "quantitative"},
          {"title", title},
          {"axis", {{"tickCount", 6}}},
          {"scale", {{"zero", false}, {"nice", false}}}};
}

const std::string height_title = "Height (µm)";
json ratio_channel() { return channel("ratio", "Material ratio (%)"); }
json height_channel(const std::string& field = "height") { return channel(field, height_title); }

json layer(json rows, json mark, json encoding) {
  return {{"data", {{"values", std::move(rows)}}}, {"mark", std::move(mark)}, {"encoding", std::move(encoding)}};
}

json place(double ratio, double height_um) { return {{"ratio", 100.0 * ratio}, {"height", height_um}}; }

json curve_points(const BearingCurve& curve) {
  json points = json::array();
  constexpr int steps = 400;
  for (int k = 0; k <= steps; ++k) {
    // Closer together at both ends, where the curve is steep.
    const double p = 0.5 - 0.5 * std::cos(std::numbers::pi * k / steps);
    points.push_back(place(p, curve.height_um(p)));
  }
  return points;
}

/// A triangle whose foot is at one ratio, and whose upright side, from level to tip, at the other.
json triangle(double foot, double upright, double level, double tip) {
  json rows = {{{"ratio", 100.0 * foot}, {"low", level}, {"high", level}},
               {{"ratio", 100.0 * upright}, {"low", std::min(level, tip)}, {"high", std::max(level, tip)}}};
  return layer(std::move(rows), {{"type", "area"}, {"color", "$series-2"}, {"opacity", 0.25}, {"line", false}},
               {{"x", ratio_channel()}, {"y", height_channel("low")}, {"y2", {{"field", "high"}}}});
}

/// Spk, Sk and Svk one above the other at the right, with their names; those that are zero are left out.
void add_levels(json& layers, double top, double bottom, const FunctionalParameters& f) {
  json rows = json::array();
  const auto add = [&rows](const char* name, double low, double high) {
    if (high > low) rows.push_back({{"name", name}, {"low", low}, {"high", high}, {"middle", 0.5 * (low + high)}});
  };
  add("Spk", top, top + f.Spk.value);
  add("Sk", bottom, top);
  add("Svk", bottom - f.Svk.value, bottom);
  layers.push_back(layer(rows,
                         {{"type", "rule"}, {"color", "$quiet"}, {"strokeWidth", 1.5}, {"x", {{"expr", "width - 14"}}}},
                         {{"y", height_channel("low")}, {"y2", {{"field", "high"}}}}));
  layers.push_back(
      layer(rows, {{"type", "text"}, {"align", "right"}, {"x", {{"expr", "width - 20"}}}, {"fontStyle", "italic"}},
            {{"y", height_channel("middle")}, {"text", {{"field", "name"}}}}));
}

json read_out() {
  return {{{"field", "ratio"}, {"title", "Smr (%)"}, {"format", ".4~g"}},
          {{"field", "height"}, {"title", "height (µm)"}, {"format", ".4~g"}}};
}

// The equivalent line passes the curve at Smr1 and at Smr2; at an end it may lie beyond all heights.
double top_of_line(const BearingCurve& curve, const FunctionalParameters& f) {
  if (f.Smr1.value > 0.0) return curve.height_um(f.Smr1.value);
  if (f.Smr2.value < 1.0) return curve.height_um(f.Smr2.value) + f.Sk.value;
  return curve.height_um(0.0);
}

}  // namespace

json bearing_chart(const TextureFindings& found) {
  const BearingCurve curve(found.field);
  const FunctionalParameters& f = found.functional;
  const double top = top_of_line(curve, f), bottom = top - f.Sk.value;
  const json points = curve_points(curve), line = {place(0.0, top), place(1.0, bottom)};
  const json x = ratio_channel(), y = height_channel();
  json layers = {triangle(f.Smr1.value, 0.0, top, top + f.Spk.value),
                 triangle(f.Smr2.value, 1.0, bottom, bottom - f.Svk.value)};
  layers.push_back(
      layer(points, {{"type", "line"}, {"color", "$series-1"}, {"strokeWidth", 2.25}}, {{"x", x}, {"y", y}}));
  layers.push_back(layer(line, {{"type", "line"}, {"color", "$ink"}, {"strokeDash", {5, 4}}, {"strokeWidth", 1.5}},
                         {{"x", x}, {"y", y}}));
  add_levels(layers, top, bottom, f);
  layers.push_back(
      layer(points, {{"type", "point"}, {"opacity", 0}, {"size", 60}}, {{"x", x}, {"y", y}, {"tooltip", read_out()}}));
  return vega_lite_chart(
      {.title = "Material ratio curve",
       .caption =
           fmt::format("Dashed: the line of least squares through the flattest 40 %; Sk is its fall. The triangles "
                       "are as large as what stands above it, up to Smr1 = {:.1f} %, and lies below it, from Smr2 = "
                       "{:.1f} %.",
                       100.0 * f.Smr1.value, 100.0 * f.Smr2.value),
       .span = Span::Half},
      {{"width", "container"}, {"height", "container"}, {"layer", layers}});
}

}  // namespace mezzotint
