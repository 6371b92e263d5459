#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "experiments/study/svg_panel.h"

/// Inside of experiments/study: what its figures have in common.

namespace mezzotint {

/// Where the lines of a figure are named.
enum class Naming { AtTheRight, InTheFirstRow, InTheLegendAlone };

/// A figure of panels in columns and rows.
class SvgFigure {
public:
  SvgFigure(std::size_t columns, std::size_t rows, const PanelAxes& axes, Naming naming)
      : columns_(columns), rows_(rows), axes_(axes), naming_(naming) {}

  void add(std::size_t column, std::size_t row, const std::string& title, const std::vector<ChartPoint>& points,
           const std::vector<std::string>& methods);
  /// @param error  name of the axis that goes up
  [[nodiscard]] std::string text(const std::string& title, const std::string& legend, const std::string& error) const;

private:
  std::size_t columns_, rows_;
  PanelAxes axes_;
  Naming naming_;
  std::string panels_;
};

/// A line of signs and their names.
class SvgLegend {
public:
  /// @param y  of the line; 50 and 74 are over the panels
  explicit SvgLegend(double y);
  void add(const std::string& sign, const std::string& name);
  [[nodiscard]] const std::string& text() const { return svg_; }

private:
  double x_, y_;
  std::string svg_;
};

}  // namespace mezzotint
