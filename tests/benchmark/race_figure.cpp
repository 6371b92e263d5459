#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "experiments/study/study_methods.h"
#include "experiments/study/svg_figure.h"
#include "race_rows.h"

namespace mezzotint::benchmark {

namespace {

// How a method of the race is drawn: the mark's name, and the place on its line.
using Drawn = std::pair<const char*, std::uint64_t>;

const std::string slopes_alone = "ladder:corrections=0:evaluations=0";

std::optional<Drawn> drawn(const std::string& method) {
  const std::string plain = "plain:algorithm=LN_BOBYQA:objective=";
  static const std::map<std::string, Drawn> all = {
      {"moments", {"ladder by levels", 1}},
      {slopes_alone, {"ladder by levels", 2}},
      {"ladder:corrections=1:evaluations=0", {"ladder by levels", 3}},
      {"ladder:corrections=1:evaluations=40", {"ladder by levels", 4}},
      {slopes_alone + ":algorithm=LN_SBPLX", {"SBPLX", 0}},
      {slopes_alone + ":algorithm=LN_COBYLA", {"COBYLA", 0}},
      {slopes_alone + ":algorithm=LD_LBFGS", {"L-BFGS", 0}},
      {slopes_alone + ":objective=cube_root", {"cube root", 0}},
      {slopes_alone + ":objective=l2", {"L2", 0}},
      {slopes_alone + ":objective=log", {"log", 0}},
      {slopes_alone + ":objective=sliced_wasserstein", {"Wasserstein", 0}},
      {slopes_alone + ":objective=moments", {"lobe's moments", 0}},
      {plain + "cube_root:rays=1e5:start=centre", {"plain, cube root", 0}},
      {plain + "l2:rays=1e5:start=centre", {"plain, L2", 0}},
      {plain + "cube_root:rays=1e5:start=closed", {"plain, our start, cube root", 0}},
      {plain + "l2:rays=1e5:start=closed", {"plain, our start, L2", 0}},
      {plain + "cube_root:rays=1e5:start=centre:tracer=own", {"plain, our tracer", 0}}};
  const auto found = all.find(method);
  return found == all.end() ? std::nullopt : std::optional<Drawn>(found->second);
}

const std::vector<std::string>& marks() {
  static const std::vector<std::string> all = {"ladder by levels",
                                               "SBPLX",
                                               "COBYLA",
                                               "L-BFGS",
                                               "cube root",
                                               "L2",
                                               "log",
                                               "Wasserstein",
                                               "lobe's moments",
                                               "plain, cube root",
                                               "plain, L2",
                                               "plain, our start, cube root",
                                               "plain, our start, L2",
                                               "plain, our tracer"};
  return all;
}

std::vector<ChartPoint> points_of(const std::vector<RaceRow>& rows, const std::string& family, int target) {
  double floor = 0.0;
  for (const RaceRow& row : rows)
    if (row.family == family && row.target == target && row.method == "truth") floor = row.cube_root;
  std::vector<ChartPoint> points;
  for (const RaceRow& row : rows) {
    const auto mark = drawn(row.method);
    if (row.family != family || row.target != target || !mark) continue;
    points.push_back({.method = mark->first,
                      .samples = mark->second,
                      .seconds = row.cpu_seconds,
                      .error = row.cube_root,
                      .error_spread = row.cube_root_error,
                      .floor = floor});
  }
  for (ChartPoint& point : points)
    point.on_front = std::ranges::none_of(points, [&](const ChartPoint& other) { return beats(other, point); });
  return points;
}

}  // namespace

std::string race_figure(const std::vector<RaceRow>& rows) {
  const std::vector<std::pair<std::string, std::string>> families = {
      {"S", "Sinusoids"}, {"R", "Ridges and sinusoid"}, {"N", "Noise"}};
  std::vector<ChartPoint> all;
  for (const auto& [letter, name] : families) {
    const auto points = points_of(rows, letter, 0);
    all.insert(all.end(), points.begin(), points.end());
  }
  PanelAxes axes = axes_of(all);
  axes.smallest = 1e-3;
  axes.largest = 1.0;
  SvgFigure figure(families.size(), 1, axes, Naming::InTheLegendAlone);
  for (std::size_t column = 0; column < families.size(); ++column)
    figure.add(column, 0, families[column].second, points_of(rows, families[column].first, 0), marks());
  SvgLegend first(50.0), second(74.0);
  for (std::size_t i = 0; i < marks().size(); ++i)
    (i < 9 ? first : second).add(svg_mark(style_of(marks()[i]), 0, 0), marks()[i]);
  second.add("<path d='M-8 0h16' class='front'/>", "Pareto front");
  return figure.text("Inverse: held-out error against time of the search", first.text() + second.text(),
                     "cube-root error, traced");
}

}  // namespace mezzotint::benchmark
