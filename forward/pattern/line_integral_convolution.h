#pragma once

#include <vector>

#include "forward/pattern/pattern_kinds.h"
#include "forward/pattern/pattern_map.h"

/// Inside of forward/pattern, and for the start of a search.

namespace mezzotint {

/// Gray of the smeared noise, before the cut.
[[nodiscard]] std::vector<float> draw_lines(const LineIntegralConvolution& lines, const Sheet& sheet);

/// Mean square slopes of noise of unit lattice, smeared over `length` along v and brought back to the noise's own
/// deviation: along u and along v.
struct LineSlopes {
  double across = 0.0;
  double along = 0.0;
  double amplitude = 1.0;  ///< that brings the smeared noise back to its deviation
};
[[nodiscard]] LineSlopes smeared_noise(double length);

}  // namespace mezzotint
