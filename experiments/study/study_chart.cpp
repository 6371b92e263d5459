#include "experiments/study/study_chart.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "experiments/report/components.h"
#include "experiments/study/label_places.h"
#include "experiments/study/study_methods.h"
#include "experiments/study/svg_panel.h"

namespace mezzotint {

namespace {

using nlohmann::json;

constexpr double height = 480.0, smallest = 1e-4, largest = 10.0;
// Room to the right of the last point, for the names.
constexpr double room_for_names = 12.0;

json choice_of(const char* name, const char* label, const std::vector<json>& values, std::size_t first) {
  return {
      {"name", name}, {"value", values[first]}, {"bind", {{"input", "select"}, {"options", values}, {"name", label}}}};
}

json questions_of(const std::string& method) {
  json list = json::array();
  for (const StudyQuestion question : study_questions()) {
    const auto& methods = methods_for(question);
    const bool always = method == plain_method || method == auto_method;
    if (always || std::find(methods.begin(), methods.end(), method) != methods.end())
      list.push_back(in_words(question));
  }
  return list;
}

json rows_of(const StudyOptions& options, const std::vector<StudyPoint>& points) {
  json rows = to_json(options, points).at("points");
  for (json& row : rows) {
    row["questions"] = questions_of(row.at("method"));
    row["shown"] = std::max(row.at("relative_l2").get<double>(), row.at("smallest_error_told").get<double>());
    const double error = row.at("relative_l2_standard_error"), seconds = row.at("seconds"),
                 spread = row.at("seconds_standard_error");
    row["low"] = std::max(row.at("relative_l2").get<double>() - error, row.at("smallest_error_told").get<double>());
    row["high"] = row.at("relative_l2").get<double>() + error;
    row["early"] = std::max(seconds - spread, 0.5 * seconds);
    row["late"] = seconds + spread;
  }
  return rows;
}

double place_of(double error) {
  return std::log(largest / std::clamp(error, smallest, largest)) / std::log(largest / smallest) * height;
}

/// What a reader may see at once: one scene, one question.
struct View {
  StudyScene scene;
  StudyQuestion question;
};

// The points that are named: the last of each method, and what `auto` chose.
std::vector<const StudyPoint*> named_points(const View& view, const std::vector<StudyPoint>& points) {
  std::vector<std::string> methods = methods_for(view.question);
  methods.emplace_back(plain_method);
  std::vector<const StudyPoint*> list;
  for (const StudyPoint& point : points) {
    if (!(point.scene == view.scene)) continue;
    const bool asked = std::find(methods.begin(), methods.end(), point.method) != methods.end();
    const auto same =
        std::find_if(list.begin(), list.end(), [&](const StudyPoint* p) { return p->method == point.method; });
    if (point.tolerance || (asked && same == list.end()))
      list.push_back(&point);
    else if (asked && point.samples > (*same)->samples)
      *same = &point;
  }
  return list;
}

std::string label_of(const StudyPoint& point) {
  return point.tolerance ? fmt::format("auto, {:.3g} %", 100.0 * *point.tolerance) : point.method;
}

// Names at the right ends of lines, none over another.
void add_names(const View& view, const std::vector<StudyPoint>& points, json& rows) {
  constexpr double distance = 16.0, margin = 8.0;
  const std::vector<const StudyPoint*> named = named_points(view, points);
  std::vector<double> wanted;
  wanted.reserve(named.size());
  for (const StudyPoint* point : named) wanted.push_back(place_of(std::max(point->error, point->floor)));
  const std::vector<double> places = label_places(wanted, distance, height - margin);
  for (std::size_t k = 0; k < named.size(); ++k) {
    rows.push_back({{"relief", view.scene.relief},
                    {"rms_gradient", view.scene.gradient},
                    {"theta_deg", view.scene.theta_deg},
                    {"questions", {in_words(view.question)}},
                    {"method", named[k]->method},
                    {"label", label_of(*named[k])},
                    {"seconds", named[k]->seconds},
                    {"shown", largest * std::pow(smallest / largest, places[k] / height)}});
  }
}

json names_of(const StudyOptions& options, const std::vector<StudyPoint>& points) {
  json rows = json::array();
  for (const StudyScene& scene : scenes_of(options))
    for (const StudyQuestion question : study_questions()) add_names({scene, question}, points, rows);
  return rows;
}

json decades(double low, double high) {
  json list = json::array();
  for (int power = static_cast<int>(std::ceil(std::log10(low) - 1e-9)); power <= std::log10(high); ++power)
    list.push_back(std::pow(10.0, power));
  return list;
}

json axis(const char* field, const char* title, double low, double high) {
  return {{"field", field},
          {"type", "quantitative"},
          {"title", title},
          {"axis", {{"format", "~g"}, {"grid", true}, {"values", decades(low, high)}}},
          {"scale", {{"type", "log"}, {"domain", {low, high}}, {"clamp", true}}}};
}

json scale_of(bool shapes) {
  json domain = json::array(), range = json::array();
  const auto add = [&](const std::string& method) {
    const StudyStyle& style = style_of(method);
    const std::string colour = style.colour, mark = style.mark;
    domain.push_back(method);
    if (shapes)
      range.push_back(mark == "triangle" ? "triangle-up" : mark);
    else
      range.push_back(colour == "#000000" ? "$ink" : colour);
  };
  add(plain_method);
  add(auto_method);
  add(moments_method);
  add(slopes_method);
  for (const PathMethod& method : path_methods())
    if (method.name != plain_method) add(method.name);
  return {{"domain", domain}, {"range", range}};
}

json by_method(bool shapes) {
  return {{"field", "method"}, {"type", "nominal"}, {"legend", nullptr}, {"scale", scale_of(shapes)}};
}

json tooltip() {
  return {{{"field", "method"}},
          {{"field", "samples"}},
          {{"field", "seconds"}, {"format", ".3g"}},
          {{"field", "seconds_standard_error"}, {"format", ".2g"}},
          {{"field", "runs"}},
          {{"field", "relative_l2"}, {"format", ".3g"}},
          {{"field", "relative_l2_standard_error"}, {"format", ".2g"}},
          {{"field", "bias"}, {"format", ".3g"}, {"title", "corrected for its own noise"}},
          {{"field", "smallest_error_told"}, {"format", ".2g"}},
          {{"field", "chosen"}}};
}

// The parts of the chart, back to front.
struct Layers {
  json x, y;

  [[nodiscard]] json floor() const {
    json line = y;
    line["field"] = "smallest_error_told";
    line["aggregate"] = "mean";
    return {{"mark", {{"type", "rect"}, {"color", "$quiet"}, {"opacity", 0.1}}},
            {"encoding", {{"y", line}, {"y2", {{"datum", smallest}}}}}};
  }
  [[nodiscard]] json front() const {
    return {{"transform", {{{"filter", "datum.on_front"}}}},
            {"mark", {{"type", "line"}, {"color", "$ink"}, {"strokeWidth", 7}, {"opacity", 0.14}}},
            {"encoding", {{"x", x}, {"y", y}, {"order", {{"field", "seconds"}}}}}};
  }
  [[nodiscard]] json lines() const {
    return {{"transform", {{{"filter", "datum.method != 'auto'"}}}},
            {"mark", {{"type", "line"}, {"strokeWidth", 1.8}}},
            {"encoding", {{"x", x}, {"y", y}, {"color", by_method(false)}, {"order", {{"field", "samples"}}}}}};
  }
  [[nodiscard]] json bars(bool of_time) const {
    json from = of_time ? x : y;
    from["field"] = of_time ? "early" : "low";
    json encoding = {{of_time ? "x" : "y", from},
                     {of_time ? "x2" : "y2", {{"field", of_time ? "late" : "high"}}},
                     {of_time ? "y" : "x", of_time ? y : x},
                     {"color", by_method(false)}};
    return {{"transform", {{{"filter", "datum.method != 'auto'"}}}}, {"mark", "rule"}, {"encoding", encoding}};
  }
  [[nodiscard]] json marks() const {
    return {{"transform", {{{"filter", "datum.method != 'auto'"}}}},
            {"mark", {{"type", "point"}, {"filled", true}, {"size", 60}, {"opacity", 1}}},
            {"encoding",
             {{"x", x}, {"y", y}, {"color", by_method(false)}, {"shape", by_method(true)}, {"tooltip", tooltip()}}}};
  }
  [[nodiscard]] json chosen() const {
    constexpr const char* star =
        "M0,-1L0.235,-0.324L0.951,-0.309L0.38,0.124L0.588,0.809L0,0.4L-0.588,0.809L-0.38,0.124"
        "L-0.951,-0.309L-0.235,-0.324Z";
    return {{"transform", {{{"filter", "datum.method == 'auto'"}}}},
            {"mark",
             {{"type", "point"},
              {"shape", star},
              {"size", 130},
              {"filled", true},
              {"opacity", 1},
              {"fill", "#ffd54a"},
              {"stroke", "$ink"},
              {"strokeWidth", 1.2}}},
            {"encoding", {{"x", x}, {"y", y}, {"tooltip", tooltip()}}}};
  }
  [[nodiscard]] json names(const json& rows, const json& filter) const {
    return {{"data", {{"values", rows}}},
            {"transform", {filter}},
            {"mark", {{"type", "text"}, {"align", "left"}, {"baseline", "middle"}, {"dx", 12}, {"fontWeight", 500}}},
            {"encoding", {{"x", x}, {"y", y}, {"text", {{"field", "label"}}}, {"color", by_method(false)}}}};
  }
};

std::vector<json> reliefs_of(const StudyOptions& options) {
  std::vector<json> list(options.families.begin(), options.families.end());
  if (options.scan) list.push_back(options.scan->family);
  return list;
}

}  // namespace

json study_chart(const StudyOptions& options, const std::vector<StudyPoint>& points) {
  const std::vector<json> gradients(options.gradients.begin(), options.gradients.end());
  const std::vector<json> thetas(options.thetas_deg.begin(), options.thetas_deg.end());
  std::vector<json> questions;
  for (const StudyQuestion question : study_questions()) questions.emplace_back(in_words(question));
  const json filter = {{"filter",
                        "datum.relief == relief && (relief == 'scan' || datum.rms_gradient == gradient) && "
                        "datum.theta_deg == theta && indexof(datum.questions, compare) >= 0"}};
  const PanelAxes reach = axes_of(chart_points(points));
  const Layers layers{axis("seconds", "CPU time of one thread (s)", reach.fastest, room_for_names * reach.slowest),
                      axis("shown", "relative L2 error", smallest, largest)};
  const json specification = {
      {"params",
       {choice_of("compare", "Compare: ", questions, 0), choice_of("relief", "Relief: ", reliefs_of(options), 0),
        choice_of("gradient", "RMS gradient: ", gradients, gradients.size() / 2),
        choice_of("theta", "Incidence (°): ", thetas, thetas.size() / 2)}},
      {"data", {{"values", rows_of(options, points)}}},
      {"transform", {filter}},
      {"width", "container"},
      {"height", height},
      {"layer",
       {layers.floor(), layers.front(), layers.lines(), layers.bars(false), layers.bars(true), layers.marks(),
        layers.names(names_of(options, points), filter), layers.chosen()}}};
  return vega_lite_chart(
      {.title = "Error against time",
       .caption =
           "Stars: what `auto` chose, at its tolerance. The broad grey line is the Pareto front of all methods, those "
           "of other comparisons included. In the grey area at the bottom no error was found: it is below the noise of "
           "the reference. Bars: ± 1 standard error. A scan has its own gradient."},
      specification);
}

}  // namespace mezzotint
