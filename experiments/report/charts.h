#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/report/components.h"
#include "forward/surface/slope_covariance.h"

namespace mezzotint {

/// A named curve. Values that are not finite are left out.
struct Series {
  std::string name;
  std::vector<double> x;
  std::vector<double> y;
  std::vector<double> standard_error;  ///< of y; empty: exact
  bool target = false;                 ///< drawn dashed, in the colour of the text
};

struct ChartAxes {
  std::string x_title;  ///< with its unit: "Wavelength (µm)"
  std::string y_title;
  bool log_x = false;  ///< values that are not positive are then left out
  bool log_y = false;
  std::optional<double> tolerance;  ///< of y; drawn as a line
};

/// Curves with bands of ± 1 standard error.
/// @throws InvalidInput for no series, or lists of different lengths.
[[nodiscard]] nlohmann::json line_chart(const Panel& panel, const ChartAxes& axes, const std::vector<Series>& series);

/// The course of a search: every evaluation's objective and the best so far, on a logarithmic axis.
/// @param objectives  in the order of evaluation; those that are not positive cannot be shown there
/// @param tolerance   drawn as a line where given
[[nodiscard]] nlohmann::json search_history(const Panel& panel, const std::vector<double>& objectives,
                                            std::optional<double> tolerance = {},
                                            const std::string& objective_title = "Objective");

struct Bar {
  std::string category;  ///< along x: "Sq", "Sdq"
  std::string series;    ///< beside each other: "design", "printed"
  double value = 0.0;
  double standard_error = 0.0;
};
/// Groups of bars with ± 1 standard error.
[[nodiscard]] nlohmann::json bar_chart(const Panel& panel, const std::string& y_title, const std::vector<Bar>& bars);

/// Densities over bins, as a histogram has them; `edges` has one entry more than `density`.
struct Histogram {
  std::string name;
  std::vector<double> edges;
  std::vector<double> density;
};
/// A slope histogram with curves over it (a target, a Gaussian).
/// @throws InvalidInput where the edges do not fit the densities.
[[nodiscard]] nlohmann::json slope_histogram(const Panel& panel, const Histogram& histogram,
                                             const std::vector<Series>& references,
                                             const std::string& x_title = "Slope along x");

struct NamedAxes {
  std::string name;
  SlopeAxes axes;
  bool target = false;
};
/// Slope covariances as 1 σ ellipses in the plane of slopes, with their long axes.
[[nodiscard]] nlohmann::json slope_ellipses(const Panel& panel, const std::vector<NamedAxes>& covariances);

}  // namespace mezzotint
