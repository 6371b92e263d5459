#include "experiments/study/study_svg.h"

#include <algorithm>

#include <fmt/format.h>

#include "experiments/study/svg_panel.h"

namespace mezzotint {

namespace {

constexpr double panel_width = 230.0, panel_height = 190.0, gap = 14.0, row_gap = 30.0, left = 74.0, top = 104.0;
constexpr double least_width = 880.0;  // the legend's

std::vector<StudyPoint> points_at(const std::vector<StudyPoint>& points, const StudyScene& scene) {
  std::vector<StudyPoint> here;
  std::copy_if(points.begin(), points.end(), std::back_inserter(here),
               [&](const StudyPoint& point) { return point.scene == scene; });
  return here;
}

/// Where the lines of a figure are named.
enum class Naming { AtTheRight, InTheFirstRow };

/// A figure of panels in columns and rows.
class Figure {
public:
  Figure(std::size_t columns, std::size_t rows, const PanelAxes& axes, Naming naming)
      : columns_(columns), rows_(rows), axes_(axes), naming_(naming) {}

  void add(std::size_t column, std::size_t row, const std::string& title, const std::vector<StudyPoint>& points,
           const std::vector<std::string>& methods) {
    PanelPlace place;
    place.width = panel_width;
    place.height = panel_height;
    place.x = left + static_cast<double>(column) * (panel_width + gap);
    place.y = top + static_cast<double>(row) * (panel_height + row_gap);
    place.numbers_left = column == 0;
    place.numbers_below = row + 1 == rows_;
    place.names_right = naming_ == Naming::AtTheRight && column + 1 == columns_;
    place.key = naming_ == Naming::InTheFirstRow && row == 0;
    place.last_column = column + 1 == columns_;
    panels_ += svg_panel(place, axes_, title, points, methods);
  }

  [[nodiscard]] std::string text(const std::string& title, const std::string& legend) const {
    const double plots_width = static_cast<double>(columns_) * (panel_width + gap) - gap,
                 plots_height = static_cast<double>(rows_) * (panel_height + row_gap) - row_gap;
    const double right = naming_ == Naming::AtTheRight ? 156.0 : 24.0;
    const double width = std::max(left + plots_width + right, least_width), height = top + plots_height + 48.0;
    std::string svg = fmt::format(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {0:.0f} {1:.0f}' width='{0:.0f}' height='{1:.0f}' "
        "font-family='Helvetica, Arial, sans-serif' font-size='11' fill='#222'>\n<style>.grid{{stroke:#dedede}}"
        ".frame{{fill:none;stroke:#888}}.front{{fill:none;stroke:#222;stroke-width:4;opacity:.16;stroke-linejoin:round}"
        "}"
        ".floor{{fill:#ededed}}.halo{{paint-order:stroke;stroke:#fff;stroke-width:3px}}</style>\n"
        "<rect width='100%' height='100%' fill='#fff'/>\n",
        width, height);
    svg += fmt::format("<text x='{:.0f}' y='24' font-size='15' font-weight='bold'>{}</text>\n", left, escaped(title));
    svg += legend + panels_;
    svg += fmt::format(
        "<text x='{:.1f}' y='{:.1f}' text-anchor='middle' font-size='12'>CPU time of one thread in "
        "s</text>\n",
        left + 0.5 * plots_width, height - 8);
    return svg + fmt::format(
                     "<text transform='translate(18 {:.1f}) rotate(-90)' text-anchor='middle' "
                     "font-size='12'>relative L2 error of the reflection</text>\n</svg>\n",
                     top + 0.5 * plots_height);
  }

private:
  std::size_t columns_, rows_;
  PanelAxes axes_;
  Naming naming_;
  std::string panels_;
};

/// A line of signs and their names.
class Legend {
public:
  explicit Legend(double y) : y_(y) {}
  void add(const std::string& sign, const std::string& name) {
    svg_ += fmt::format("<g transform='translate({:.1f} {:.1f})'>{}</g><text x='{:.1f}' y='{:.1f}'>{}</text>\n", x_,
                        y_ - 4, sign, x_ + 13, y_, escaped(name));
    x_ += 34.0 + 5.9 * static_cast<double>(name.size());
  }
  [[nodiscard]] const std::string& text() const { return svg_; }

private:
  double x_ = left + 6.0, y_;
  std::string svg_;
};

std::string legend_of(const std::vector<std::string>& methods) {
  Legend first(50.0), second(74.0);
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
  Figure figure(options.thetas_deg.size(), gradients.size(), axes_of(points), Naming::AtTheRight);
  for (std::size_t row = 0; row < gradients.size(); ++row) {
    for (std::size_t column = 0; column < options.thetas_deg.size(); ++column) {
      const StudyScene scene{relief, gradients[row], options.thetas_deg[column]};
      figure.add(column, row, fmt::format("s = {:.3g}, θ = {:.3g}°", scene.gradient, scene.theta_deg),
                 points_at(points, scene), methods);
    }
  }
  return figure.text(fmt::format("Error against time: {}, {}", relief, setting(options, relief)), legend_of(methods));
}

std::string study_choices_svg(const StudyOptions& options, const std::vector<StudyPoint>& points) {
  std::vector<std::string> reliefs = options.families;
  if (options.scan) reliefs.push_back(options.scan->family);
  const double theta = options.thetas_deg[std::max<std::size_t>(options.thetas_deg.size(), 2) - 2];
  const std::vector<StudyQuestion> questions(study_questions().begin() + 1, study_questions().end());
  Figure figure(questions.size(), reliefs.size(), axes_of(points), Naming::InTheFirstRow);
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
      legend_of({}));
}

}  // namespace mezzotint
