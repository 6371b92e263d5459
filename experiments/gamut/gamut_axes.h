#pragma once

#include <string>
#include <vector>

#include "experiments/gamut/gamut_findings.h"

/// Inside of experiments/gamut: what the figure and the page have in common.

namespace mezzotint {

/// What both axes reach over, logarithmic.
struct AlphaAxes {
  double low_x = 0.01, high_x = 1.0, low_y = 0.01, high_y = 1.0;
};
[[nodiscard]] AlphaAxes axes_of(const GamutFindings& findings);

/// 1, 2, 5 times powers of ten.
[[nodiscard]] std::vector<double> ticks(double low, double high);

/// A colour for each of gamut_kind_names(), told apart by people who see few colours.
[[nodiscard]] std::string colour_of(const std::string& kind);

}  // namespace mezzotint
