#pragma once

#include <span>
#include <string>
#include <vector>

#include "forward/pattern/pattern.h"
#include "forward/pattern/pattern_map.h"

/// Inside of forward/pattern.

namespace mezzotint {

/// A pattern as gray: heights divided by the pattern's height, in [0, 1], row by row.
struct Drawing {
  std::vector<float> gray;
  /// ∂gray/∂(number), one a name, each as `gray`; empty where it is 0 everywhere.
  std::vector<std::vector<float>> slopes;

  /// The slopes toward that number, to be written to.
  [[nodiscard]] std::vector<float>& toward(std::size_t number) {
    if (slopes[number].empty()) slopes[number].resize(gray.size(), 0.0F);
    return slopes[number];
  }
};

/// @param names  the numbers toward which slopes are wanted, by their paths; the gray has the same bits with any. With
///               some, the sheet must not be periodic: fitting to a tile goes by whole periods.
[[nodiscard]] Drawing draw_pattern(const Pattern& pattern, const Sheet& sheet, std::span<const std::string> names);

[[nodiscard]] inline std::vector<float> draw_gray(const Pattern& pattern, const Sheet& sheet) {
  return draw_pattern(pattern, sheet, {}).gray;
}

/// Gray as heights.
[[nodiscard]] HeightField heights_of(const std::vector<float>& gray, const Pattern& pattern, const Grid& grid,
                                     Continuation continuation);

}  // namespace mezzotint
