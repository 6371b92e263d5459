#pragma once

#include <string>
#include <utility>
#include <vector>

#include "experiments/study/chart_point.h"
#include "experiments/study/study_methods.h"

/// Inside of experiments/study: the pieces of its figures.

namespace mezzotint {

/// Text that is no markup.
[[nodiscard]] std::string escaped(const std::string& text);

/// A method's mark at a place of the figure; hollow where nothing but an upper bound is known.
[[nodiscard]] std::string svg_mark(const StudyStyle& style, double x, double y, bool hollow = false);

/// What the axes of all panels of a figure reach over, both logarithmic.
struct PanelAxes {
  double fastest = 1e-4, slowest = 10.0;   ///< s
  double smallest = 1e-4, largest = 10.0;  ///< relative L2
};
/// Whole decades of time about all points.
[[nodiscard]] PanelAxes axes_of(const std::vector<ChartPoint>& points);

/// Where a panel stands in the figure, and what is written on its sides; `key`: signs and names in its lower left
/// corner.
struct PanelPlace {
  double x = 0.0, y = 0.0, width = 230.0, height = 190.0;
  bool numbers_left = true, numbers_below = true, last_column = true, names_right = true, key = false;
};

/// One scene: error against time of some methods, the Pareto front, what `auto` chose, and what cannot be told.
/// @param methods  are drawn, in this order, besides the plain method and `auto`
[[nodiscard]] std::string svg_panel(const PanelPlace& place, const PanelAxes& axes, const std::string& title,
                                    const std::vector<ChartPoint>& points, const std::vector<std::string>& methods);

}  // namespace mezzotint
