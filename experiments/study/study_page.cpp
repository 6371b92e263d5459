#include "experiments/study/study_page.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include <fmt/format.h>

#include "experiments/report/components.h"
#include "experiments/study/scene.h"

namespace mezzotint {

namespace {

nlohmann::json axis(const char* field, const char* title) {
  return {{"field", field}, {"type", "quantitative"}, {"title", title}, {"scale", {{"type", "log"}}}};
}

nlohmann::json choice_of(const char* name, const char* label, const std::vector<nlohmann::json>& values,
                         std::size_t first) {
  return {
      {"name", name}, {"value", values[first]}, {"bind", {{"input", "select"}, {"options", values}, {"name", label}}}};
}

nlohmann::json chart(const StudyOptions& options, const std::vector<StudyPoint>& points) {
  const std::vector<nlohmann::json> reliefs(study_families().begin(), study_families().end());
  const std::vector<nlohmann::json> gradients(options.gradients.begin(), options.gradients.end());
  const std::vector<nlohmann::json> thetas(options.thetas_deg.begin(), options.thetas_deg.end());
  const nlohmann::json x = axis("seconds", "CPU time of one thread (s)"), y = axis("relative_l2", "relative L2 error");
  const nlohmann::json tooltip = {{{"field", "method"}},
                                  {{"field", "samples"}},
                                  {{"field", "seconds"}, {"format", ".3g"}},
                                  {{"field", "relative_l2"}, {"format", ".3g"}},
                                  {{"field", "reference_error"}, {"format", ".3g"}}};
  const nlohmann::json colour = {{"field", "method"},
                                 {"type", "nominal"},
                                 {"title", "method"},
                                 {"legend", {{"orient", "right"}, {"labelLimit", 320}}},
                                 {"scale", {{"scheme", "tableau20"}}}};
  const nlohmann::json lines = {
      {"transform", {{{"filter", "datum.method != 'auto'"}}}},
      {"mark", {{"type", "line"}, {"point", {{"size", 40}}}}},
      {"encoding", {{"x", x}, {"y", y}, {"color", colour}, {"tooltip", tooltip}, {"order", {{"field", "samples"}}}}}};
  const nlohmann::json front = {{"transform", {{{"filter", "datum.on_front"}}}},
                                {"mark", {{"type", "line"}, {"color", "$ink"}, {"strokeDash", {5, 3}}}},
                                {"encoding", {{"x", x}, {"y", y}, {"order", {{"field", "seconds"}}}}}};
  const nlohmann::json chosen = {
      {"transform", {{{"filter", "datum.method == 'auto'"}}}},
      {"mark", {{"type", "point"}, {"shape", "diamond"}, {"size", 240}, {"strokeWidth", 2.5}, {"color", "$accent"}}},
      {"encoding", {{"x", x}, {"y", y}, {"tooltip", tooltip}}}};
  const nlohmann::json floor = {{"mark", {{"type", "rule"}, {"color", "$quiet"}, {"strokeDash", {1, 3}}}},
                                {"encoding", {{"y", {{"aggregate", "mean"}, {"field", "reference_error"}}}}}};
  const nlohmann::json specification = {
      {"params",
       {choice_of("relief", "Relief ", reliefs, 0),
        choice_of("gradient", "RMS gradient ", gradients, gradients.size() / 2),
        choice_of("theta", "Incidence (°) ", thetas, thetas.size() / 2)}},
      {"data", {{"values", to_json(options, points).at("points")}}},
      {"transform",
       {{{"filter", "datum.relief == relief && datum.rms_gradient == gradient && datum.theta_deg == theta"}}}},
      {"width", "container"},
      {"height", 460},
      {"layer", {floor, lines, front, chosen}}};
  return vega_lite_chart(
      {.title = "Error against time",
       .caption = "Dashed: the Pareto front. Diamond: what auto chose at its tolerance. Dotted: the error of "
                  "the reference, below which nothing can be told."},
      specification);
}

// On how many scenes a method stands on the front.
nlohmann::json front_table(const std::vector<StudyPoint>& points) {
  std::map<std::string, int> count;
  for (const StudyPoint& point : points) count[point.method] += point.on_front ? 1 : 0;
  std::vector<std::pair<int, std::string>> order;
  for (const auto& [method, times] : count) {
    if (method != "auto") order.emplace_back(times, method);
  }
  std::sort(order.rbegin(), order.rend());
  std::vector<TableRow> rows;
  for (const auto& [times, method] : order) rows.push_back({{method, times}});
  return table({.title = "Points on the Pareto front", .span = Span::Half}, {"Method", "Points"}, rows);
}

// The time of the slides' plain method to 1 %, by the N^−½ of its last point, over that of the fastest at that error.
nlohmann::json speed_table(const StudyOptions& options, const std::vector<StudyPoint>& points) {
  std::vector<TableRow> rows;
  constexpr double goal = 0.02;
  for (const std::string& relief : study_families()) {
    for (const double gradient : options.gradients) {
      for (const double theta : options.thetas_deg) {
        double plain = 0.0, best = INFINITY;
        std::string method = "none";
        for (const StudyPoint& point : points) {
          if (point.relief != relief || point.gradient != gradient || point.theta_deg != theta) continue;
          if (point.method == "slides plain")
            plain = point.seconds * std::pow(point.error / goal, 2.0);
          else if (point.method != "auto" && point.error <= goal && point.seconds < best) {
            best = point.seconds;
            method = point.method;
          }
        }
        if (!std::isfinite(best)) {
          rows.push_back({{relief, gradient, theta, "no point measured reaches it", nullptr, nullptr}});
        } else {
          rows.push_back({{relief, gradient, theta, method, best, plain / best}});
        }
      }
    }
  }
  return table(
      {.title = "Time to 2 %, against the slides' plain method",
       .caption =
           "The plain method's time is extrapolated by N^−½ from its last point (2^18 paths); its fixed costs are "
           "so small that this is a little too kind to it where its error is above 2 %."},
      {"Relief", "RMS gradient", "Incidence (°)", "Fastest measured", "Its seconds", "Times faster"}, rows);
}

}  // namespace

Report study_page(const StudyOptions& options, const std::vector<StudyPoint>& points) {
  Report report;
  report.title = "Error against time";
  report.subtitle =
      fmt::format("{}² cells, {}² bins, {}", options.cells, options.resolution, to_string(options.material));
  report.verdict = {Outcome::Information,
                    fmt::format("{} measurements of {} scenes, on one thread.", points.size(),
                                study_families().size() * options.gradients.size() * options.thetas_deg.size())};
  report.sections.push_back(
      {"Chart",
       "Every point is one run. The error is `relative_l2` of the reflection to a long run with another "
       "seed, its own noise included.",
       {chart(options, points)}});
  report.sections.push_back({"Summary", "", {front_table(points), speed_table(options, points)}});
  return report;
}

}  // namespace mezzotint
