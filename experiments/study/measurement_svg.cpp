#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "experiments/study/measurement_study.h"
#include "experiments/study/study_methods.h"
#include "experiments/study/svg_figure.h"

namespace mezzotint {

namespace {

struct Words {
  const char *title, *length, *error;
};

Words words_of(MeasurementQuestion question) {
  switch (question) {
    case MeasurementQuestion::Filling:
      return {"Error against time: filling holes", "holes of {:.3g} µm", "RMS error in the holes ÷ Sq"};
    case MeasurementQuestion::Filtering:
      return {"Error against time: S-filter", "cut-off of {:.3g} µm", "RMS error ÷ RMS of what passes"};
    case MeasurementQuestion::Sampling:
      break;
  }
  return {"Error against time: Sq of a part of the samples", "texture of {:.3g} µm", "relative error of Sq"};
}

std::string legend_of(const std::vector<std::string>& methods) {
  SvgLegend first(50.0), second(74.0);
  for (const std::string& method : methods) first.add(svg_mark(style_of(method), 0, 0), method);
  second.add("<path d='M-8 0h16' class='front'/>", "Pareto front of all methods");
  second.add("<circle r='2.7' fill='#fff' stroke='#222'/>", "less than 10⁻⁴, or none");
  return first.text() + second.text();
}

// Whole decades about the errors.
PanelAxes axes_about(const std::vector<ChartPoint>& points) {
  PanelAxes axes = axes_of(points);
  double low = 1.0, high = 0.0;
  for (const ChartPoint& point : points) {
    low = std::min(low, point.told());
    high = std::max(high, point.told());
  }
  axes.smallest = std::pow(10.0, std::floor(std::log10(low)));
  axes.largest = std::pow(10.0, std::ceil(std::log10(high)));
  return axes;
}

}  // namespace

std::string measurement_svg(const MeasurementStudyOptions& options, const std::vector<MeasurementPanel>& panels,
                            MeasurementQuestion question) {
  std::vector<std::string> surfaces;
  std::vector<ChartPoint> all;
  std::size_t count = 0;
  for (const MeasurementPanel& panel : panels) {
    if (panel.question != question) continue;
    if (surfaces.empty() || surfaces.back() != panel.surface) surfaces.push_back(panel.surface);
    all.insert(all.end(), panel.points.begin(), panel.points.end());
    ++count;
  }
  const Words words = words_of(question);
  const std::vector<std::string>& methods = methods_for(question);
  const std::size_t columns = count / std::max<std::size_t>(1, surfaces.size());
  SvgFigure figure(columns, surfaces.size(), axes_about(all), Naming::InTheLegendAlone);
  std::size_t column = 0, row = 0;
  for (const MeasurementPanel& panel : panels) {
    if (panel.question != question) continue;
    const std::string length = fmt::format(fmt::runtime(words.length), panel.length_um);
    const std::string title = surfaces.size() > 1 ? panel.surface + ", " + length : length;
    figure.add(column, row, title, panel.points, methods);
    row += column + 1 == columns ? 1 : 0;
    column = column + 1 == columns ? 0 : column + 1;
  }
  return figure.text(fmt::format("{}, {}² samples 1 µm apart", words.title, options.cells), legend_of(methods),
                     words.error);
}

}  // namespace mezzotint
