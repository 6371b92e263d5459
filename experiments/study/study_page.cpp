#include "experiments/study/study_page.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include <fmt/format.h>

#include "experiments/report/components.h"
#include "experiments/study/study_chart.h"
#include "experiments/study/study_methods.h"

namespace mezzotint {

namespace {

// On how many scenes a method stands on the front.
nlohmann::json front_table(const std::vector<StudyPoint>& points) {
  std::map<std::string, int> count;
  for (const StudyPoint& point : points) count[point.method] += point.on_front ? 1 : 0;
  std::vector<std::pair<int, std::string>> order;
  for (const auto& [method, times] : count) {
    if (method != auto_method) order.emplace_back(times, method);
  }
  std::sort(order.rbegin(), order.rend());
  std::vector<TableRow> rows;
  for (const auto& [times, method] : order) rows.push_back({{method, times}});
  return table({.title = "Points on the Pareto front", .span = Span::Half}, {"Method", "Points"}, rows);
}

// What `auto` took, and how near it came.
nlohmann::json auto_table(const std::vector<StudyPoint>& points) {
  std::vector<TableRow> rows;
  for (const StudyPoint& point : points) {
    if (!point.tolerance) continue;
    // Two standard errors: one run in forty looks worse than that by chance.
    const bool met = point.bias - 2.0 * point.bias_error <= *point.tolerance;
    const Outcome outcome = met ? Outcome::Met : Outcome::Missed;
    rows.push_back(
        {{point.scene.relief, point.scene.gradient, point.scene.theta_deg, 100.0 * *point.tolerance, point.chosen,
          Quantity{point.bias, "1", point.bias_error}, point.error, Quantity{point.seconds, "s", point.seconds_error}},
         outcome});
  }
  return table(
      {.title = "What auto chose",
       .caption = "*True error*: `relative_l2` to the reference, corrected for the noise of both by independent "
                  "halves; it is what the tolerance is judged by. *With its noise*: of the reference alone."},
      {"Relief", "RMS gradient", "Incidence (°)", "Tolerance (%)", "Chosen", "True error", "With its noise", "Time"},
      rows);
}

struct Fastest {
  double plain = NAN;  ///< seconds of the plain method, extrapolated
  double seconds = INFINITY;
  std::string method;
};

// The plain method's error falls as N^−½ from its last point on.
Fastest fastest_to(double goal, const std::vector<StudyPoint>& points, const StudyScene& scene) {
  Fastest fastest;
  for (const StudyPoint& point : points) {
    if (!(point.scene == scene)) continue;
    if (point.method == plain_method)
      fastest.plain = point.seconds * std::pow(point.error / goal, 2.0);
    else if (point.method != auto_method && point.error <= goal && point.seconds < fastest.seconds) {
      fastest.seconds = point.seconds;
      fastest.method = point.method;
    }
  }
  return fastest;
}

nlohmann::json speed_table(const StudyOptions& options, const std::vector<StudyPoint>& points) {
  constexpr double goal = 0.02;
  std::vector<TableRow> rows;
  for (const StudyScene& scene : scenes_of(options)) {
    const Fastest fastest = fastest_to(goal, points, scene);
    TableRow row{{scene.relief, scene.gradient, scene.theta_deg}};
    if (fastest.method.empty())
      row.cells.insert(row.cells.end(), {"no point measured reaches it", nullptr, nullptr});
    else
      row.cells.insert(row.cells.end(), {fastest.method, fastest.seconds, fastest.plain / fastest.seconds});
    rows.push_back(row);
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
  report.verdict = {Outcome::Information, fmt::format("{} measurements of {} scenes, on one thread.", points.size(),
                                                      scenes_of(options).size())};
  report.sections.push_back(
      {"Chart",
       "Every point is one budget. The error is `relative_l2` of the reflection to 2^22 paths with another seed, whose "
       "noise is taken out; time is the median of up to five runs.",
       {study_chart(options, points)}});
  report.sections.push_back({"The choice of auto", "", {auto_table(points)}});
  report.sections.push_back({"Summary", "", {front_table(points), speed_table(options, points)}});
  return report;
}

}  // namespace mezzotint
