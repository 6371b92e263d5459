#pragma once

#include <optional>

#include "forward/pattern/pattern.h"
#include "forward/pattern/pattern_map.h"

/// Inside of forward/pattern.

namespace mezzotint {

/// Moments of a gray (heights divided by the pattern's height), before it is cut; slopes a µm.
struct GrayMoments {
  double mean = 0.0;
  double variance = 0.0;
  SlopeCovariance slopes;
};
/// None where there is no closed form.
[[nodiscard]] std::optional<GrayMoments> closed_form_moments(const Pattern& pattern, const Sheet& sheet);

}  // namespace mezzotint
