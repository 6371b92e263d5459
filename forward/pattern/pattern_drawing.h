#pragma once

#include <vector>

#include "forward/pattern/pattern.h"
#include "forward/pattern/pattern_map.h"

/// Inside of forward/pattern.

namespace mezzotint {

/// The pattern as gray: heights divided by the pattern's height, in [0, 1], row by row.
[[nodiscard]] std::vector<float> draw_gray(const Pattern& pattern, const Sheet& sheet);

}  // namespace mezzotint
