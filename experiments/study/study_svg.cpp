#include "experiments/study/study_svg.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace mezzotint {

namespace {

constexpr double panel_width = 230.0, panel_height = 190.0, gap = 14.0, left = 74.0, top = 52.0, legend = 250.0;
constexpr double fastest = 1e-4, slowest = 10.0, smallest = 1e-4, largest = 3.0;

// Okabe & Ito's colours, which readers with any colour vision can tell apart; and a mark, for print without colour.
struct Style {
  const char* method;
  const char* colour;
  const char* mark;
};
constexpr Style styles[] = {{"slides plain", "#000000", "square"},
                            {"paths, Embree", "#7f7f7f", "circle"},
                            {"paths, random positions", "#e69f00", "circle"},
                            {"paths, lattice", "#56b4e9", "diamond"},
                            {"paths, strata", "#0072b2", "circle"},
                            {"paths, strata, interpolated normals", "#0072b2", "square"},
                            {"paths, splat corrected", "#d55e00", "circle"},
                            {"paths, splat corrected, 2 bounces", "#cc79a7", "diamond"},
                            {"paths, splat corrected, mesh halved", "#cc79a7", "square"},
                            {"single", "#009e73", "diamond"},
                            {"slopes", "#009e73", "square"},
                            {"moments", "#8a6d00", "square"},
                            {"auto", "#d00000", "star"}};

const Style& style_of(const std::string& method) {
  const auto* found =
      std::find_if(std::begin(styles), std::end(styles), [&](const Style& s) { return method == s.method; });
  return found == std::end(styles) ? styles[0] : *found;
}

std::string mark(const Style& style, double x, double y) {
  const std::string kind = style.mark;
  if (kind == "circle") return fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='3' fill='{}'/>", x, y, style.colour);
  if (kind == "square")
    return fmt::format("<rect x='{:.1f}' y='{:.1f}' width='5.6' height='5.6' fill='{}'/>", x - 2.8, y - 2.8,
                       style.colour);
  if (kind == "diamond")
    return fmt::format("<path d='M{:.1f} {:.1f}l3.8 3.8l-3.8 3.8l-3.8 -3.8z' fill='{}'/>", x, y - 3.8, style.colour);
  std::string star = "<path d='";
  for (int k = 0; k < 10; ++k) {
    const double radius = k % 2 == 0 ? 8.0 : 3.4, angle = 0.62831853 * k;
    star +=
        fmt::format("{}{:.1f} {:.1f}", k == 0 ? 'M' : 'L', x + radius * std::sin(angle), y - radius * std::cos(angle));
  }
  return star + fmt::format("z' fill='none' stroke='{}' stroke-width='1.6'/>", style.colour);
}

class Panel {
public:
  Panel(double x, double y) : x_(x), y_(y) {}

  [[nodiscard]] double across(double seconds) const {
    const double t = std::log(std::clamp(seconds, fastest, slowest) / fastest) / std::log(slowest / fastest);
    return x_ + t * panel_width;
  }
  [[nodiscard]] double down(double error) const {
    const double t = std::log(std::clamp(error, smallest, largest) / smallest) / std::log(largest / smallest);
    return y_ + (1.0 - t) * panel_height;
  }

  [[nodiscard]] std::string frame(bool first_column, bool last_column, bool last_row) const {
    std::string svg;
    for (int power = -4; power <= 1; ++power) {
      const double at = across(std::pow(10.0, power));
      svg += fmt::format("<line x1='{0:.1f}' y1='{1:.1f}' x2='{0:.1f}' y2='{2:.1f}' class='grid'/>", at, y_,
                         y_ + panel_height);
      // The next panel's first label stands where this one's last would.
      if (last_row && (power < 1 || last_column))
        svg += fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='middle'>{}</text>", at, y_ + panel_height + 15,
                           label(power));
    }
    for (int power = -4; power <= 0; ++power) {
      const double at = down(std::pow(10.0, power));
      svg += fmt::format("<line x1='{1:.1f}' y1='{0:.1f}' x2='{2:.1f}' y2='{0:.1f}' class='grid'/>", at, x_,
                         x_ + panel_width);
      if (first_column)
        svg += fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='end'>{}</text>", x_ - 6, at + 4, label(power));
    }
    return svg + fmt::format("<rect x='{:.1f}' y='{:.1f}' width='{}' height='{}' class='frame'/>", x_, y_, panel_width,
                             panel_height);
  }

  [[nodiscard]] std::string draw(std::vector<StudyPoint> points) const {
    std::string svg;
    std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.seconds < b.seconds; });
    std::string front;
    for (const StudyPoint& point : points) {
      if (point.on_front)
        front += fmt::format("{}{:.1f} {:.1f}", front.empty() ? 'M' : 'L', across(point.seconds), down(point.error));
    }
    if (!points.empty()) {
      const double at = down(points.front().floor);
      svg += fmt::format("<line x1='{1:.1f}' y1='{0:.1f}' x2='{2:.1f}' y2='{0:.1f}' class='floor'/>", at, x_,
                         x_ + panel_width);
    }
    svg += "<path d='" + front + "' class='front'/>";
    for (const StudyPoint& point : points)
      svg += mark(style_of(point.method), across(point.seconds), down(point.error));
    return svg;
  }

  static std::string label(int power) {
    return fmt::format("10<tspan dy='-4' font-size='8'>{}{}</tspan>", power < 0 ? "−" : "", std::abs(power));
  }

private:
  double x_, y_;
};

std::string legend_svg(double x, double y) {
  std::string svg;
  for (const Style& style : styles) {
    svg += mark(style, x, y - 4) + fmt::format("<text x='{:.1f}' y='{:.1f}'>{}</text>", x + 14, y, style.method);
    y += 19;
  }
  svg += fmt::format("<path d='M{:.1f} {:.1f}h20' class='front'/><text x='{:.1f}' y='{:.1f}'>Pareto front</text>",
                     x - 8, y - 4, x + 18, y);
  y += 19;
  return svg +
         fmt::format(
             "<path d='M{:.1f} {:.1f}h20' class='floor'/><text x='{:.1f}' y='{:.1f}'>error of the reference</text>",
             x - 8, y - 4, x + 18, y);
}

}  // namespace

std::string study_svg(const StudyOptions& options, const std::vector<StudyPoint>& points, const std::string& relief) {
  const auto columns = static_cast<double>(options.thetas_deg.size()),
             rows = static_cast<double>(options.gradients.size());
  const double plots_width = columns * (panel_width + gap), plots_height = rows * (panel_height + gap);
  const double width = left + plots_width + legend, height = top + plots_height + 46.0;
  std::string svg = fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {0:.0f} {1:.0f}' width='{0:.0f}' height='{1:.0f}' "
      "font-family='Helvetica, Arial, sans-serif' font-size='11' fill='#222'>\n<style>.grid{{stroke:#e4e4e4}}"
      ".frame{{fill:none;stroke:#888}}.front{{fill:none;stroke:#222;stroke-width:1.2;stroke-dasharray:4 3}}"
      ".floor{{stroke:#b0b0b0;stroke-width:1.2;stroke-dasharray:1 3}}</style>\n<rect width='100%' height='100%' "
      "fill='#fff'/>\n",
      width, height);
  svg += fmt::format(
      "<text x='{:.0f}' y='20' font-size='14' font-weight='bold'>Error against time: {} relief, {}² cells, {}, "
      "{}² bins</text>\n",
      left, relief, options.cells, to_string(options.material), options.resolution);
  for (std::size_t row = 0; row < options.gradients.size(); ++row) {
    for (std::size_t column = 0; column < options.thetas_deg.size(); ++column) {
      const Panel panel(left + static_cast<double>(column) * (panel_width + gap),
                        top + static_cast<double>(row) * (panel_height + gap));
      std::vector<StudyPoint> here;
      for (const StudyPoint& point : points) {
        if (point.relief == relief && point.gradient == options.gradients[row] &&
            point.theta_deg == options.thetas_deg[column])
          here.push_back(point);
      }
      svg += panel.frame(column == 0, column + 1 == options.thetas_deg.size(), row + 1 == options.gradients.size()) +
             panel.draw(here) + "\n";
      svg += fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='end' font-weight='bold'>s = {}, {}°</text>\n",
                         panel.across(slowest) - 6, panel.down(largest) + 14, options.gradients[row],
                         options.thetas_deg[column]);
    }
  }
  svg += legend_svg(left + plots_width + 22, top + 12);
  svg += fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='middle'>CPU time of one thread (s)</text>\n",
                     left + 0.5 * plots_width, height - 8);
  svg += fmt::format(
      "<text transform='translate(18 {:.1f}) rotate(-90)' text-anchor='middle'>relative L2 error of the "
      "reflection</text>\n</svg>\n",
      top + 0.5 * plots_height);
  return svg;
}

}  // namespace mezzotint
