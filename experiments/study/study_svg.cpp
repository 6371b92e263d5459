#include "experiments/study/study_svg.h"

#include <algorithm>

#include <fmt/format.h>

#include "experiments/study/svg_figure.h"

namespace mezzotint {

namespace {

constexpr const char* error_axis = "relative L2 error of the reflection";

std::vector<ChartPoint> points_at(const std::vector<StudyPoint>& points, const StudyScene& scene) {
  std::vector<ChartPoint> here;
  std::copy_if(points.begin(), points.end(), std::back_inserter(here),
               [&](const StudyPoint& point) { return point.scene == scene; });
  return here;
}

std::string legend_of(const std::vector<std::string>& methods) {
  SvgLegend first(50.0), second(74.0);
  (methods.empty() ? second : first).add(svg_mark(style_of(plain_method), 0, 0), plain_method);
  for (const std::string& method : methods) first.add(svg_mark(style_of(method), 0, 0), method);
  second.add(svg_mark(style_of(auto_method), 0, 0), "what auto chose, at its tolerance");
  second.add("<path d='M-8 0h16' class='front'/>", "Pareto front of all methods");
  second.add("<rect x='-8' y='-5' width='16' height='10' class='floor'/>", "below the noise of the reference");
  second.add("<circle r='2.7' fill='#fff' stroke='#222'/>", "no error found");
  return first.text() + second.text();
}

std::string setting(const StudyOptions& options, const std::string& relief) {
  const std::string cells = relief == "scan" && options.scan
                                ? fmt::format("{} × {}", options.scan->field.columns(), options.scan->field.rows())
                                : fmt::format("{}²", options.cells);
  return fmt::format("{} cells, {}, {}² bins", cells, to_string(options.material), options.resolution);
}

std::vector<double> gradients_of(const StudyOptions& options, const std::string& relief) {
  return relief == "scan" && options.scan ? std::vector<double>{options.scan->gradient} : options.gradients;
}

}  // namespace

std::string study_svg(const StudyOptions& options, const std::vector<StudyPoint>& points, const std::string& relief) {
  const std::vector<double> gradients = gradients_of(options, relief);
  const std::vector<std::string>& methods = methods_for(StudyQuestion::Rungs);
  SvgFigure figure(options.thetas_deg.size(), gradients.size(), axes_of(chart_points(points)), Naming::AtTheRight);
  for (std::size_t row = 0; row < gradients.size(); ++row) {
    for (std::size_t column = 0; column < options.thetas_deg.size(); ++column) {
      const StudyScene scene{relief, gradients[row], options.thetas_deg[column]};
      figure.add(column, row, fmt::format("s = {:.3g}, θ = {:.3g}°", scene.gradient, scene.theta_deg),
                 points_at(points, scene), methods);
    }
  }
  return figure.text(fmt::format("Error against time: {}, {}", relief, setting(options, relief)), legend_of(methods),
                     error_axis);
}

std::string study_choices_svg(const StudyOptions& options, const std::vector<StudyPoint>& points) {
  std::vector<std::string> reliefs = options.families;
  if (options.scan) reliefs.push_back(options.scan->family);
  const double theta = options.thetas_deg[std::max<std::size_t>(options.thetas_deg.size(), 2) - 2];
  const std::vector<StudyQuestion> questions(study_questions().begin() + 1, study_questions().end());
  SvgFigure figure(questions.size(), reliefs.size(), axes_of(chart_points(points)), Naming::InTheFirstRow);
  for (std::size_t row = 0; row < reliefs.size(); ++row) {
    const std::vector<double> gradients = gradients_of(options, reliefs[row]);
    const StudyScene scene{reliefs[row], gradients[gradients.size() / 2], theta};
    for (std::size_t column = 0; column < questions.size(); ++column) {
      const std::vector<std::string>& methods = methods_for(questions[column]);
      figure.add(column, row, fmt::format("{}: {}", reliefs[row], in_words(questions[column])),
                 points_at(points, scene), methods);
    }
  }
  return figure.text(
      fmt::format("What else one may choose: s = {:.3g} (scan: its own), θ = {:.3g}°, {}",
                  options.gradients[options.gradients.size() / 2], theta, setting(options, reliefs.front())),
      legend_of({}), error_axis);
}

}  // namespace mezzotint
