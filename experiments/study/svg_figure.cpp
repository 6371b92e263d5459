#include "experiments/study/svg_figure.h"

#include <algorithm>

#include <fmt/format.h>

namespace mezzotint {

namespace {

constexpr double panel_width = 230.0, panel_height = 190.0, gap = 14.0, row_gap = 30.0, left = 74.0, top = 104.0;
constexpr double least_width = 880.0;  // the legend's

}  // namespace

void SvgFigure::add(std::size_t column, std::size_t row, const std::string& title,
                    const std::vector<ChartPoint>& points, const std::vector<std::string>& methods) {
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

std::string SvgFigure::text(const std::string& title, const std::string& legend, const std::string& error) const {
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
                   "font-size='12'>{}</text>\n</svg>\n",
                   top + 0.5 * plots_height, escaped(error));
}

SvgLegend::SvgLegend(double y) : x_(left + 6.0), y_(y) {}

void SvgLegend::add(const std::string& sign, const std::string& name) {
  svg_ += fmt::format("<g transform='translate({:.1f} {:.1f})'>{}</g><text x='{:.1f}' y='{:.1f}'>{}</text>\n", x_,
                      y_ - 4, sign, x_ + 13, y_, escaped(name));
  x_ += 34.0 + 5.9 * static_cast<double>(name.size());
}

}  // namespace mezzotint
