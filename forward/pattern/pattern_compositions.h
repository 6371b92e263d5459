#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "forward/base/units.h"
#include "forward/pattern/pattern_kinds.h"

/// Patterns made of patterns. Each is a value that holds its parts; a part may be a composition again.
///
/// Frame    all parts lie in one plane, with one origin.
/// Random   parts with the same seed are still independent of one another: a part's numbers follow from its seed and
///          its place in the composition.

namespace mezzotint {

struct PatternPart;  // pattern.h

/// The heights of its parts, added. Height: the sum of theirs.
struct PatternSum {
  std::vector<PatternPart> parts;
};

/// height · Π (height of a part divided by its largest): one part shades the other. The parts' own heights do not
/// count.
struct PatternProduct {
  Length height = Length::from_um(16.0);
  std::vector<PatternPart> parts;
};

/// Its part, turned counter-clockwise about `centre`.
struct TurnedPattern {
  Angle rotation;
  Position centre;
  std::vector<PatternPart> parts;  ///< one
};

/// One part where the mask is at or above `threshold`, another where it is below. `softness` is the range of the mask's
/// values over which one passes into the other by a cubic; 0 makes a cliff. Height: the larger one's.
struct MaskedPattern {
  double threshold = 0.5;  ///< of the mask's largest height
  double softness = 0.0;
  std::vector<PatternPart> parts;  ///< inside, outside, mask
};

/// A picture whose pixels say which part lies where; beyond its edges it repeats. Height: the largest one's.
///
/// Frame    row 0 at y = 0, like a height field.
struct PatternRegions {
  Length pixel = Length::from_um(10.0);
  Position corner;  ///< of the picture's pixel (0, 0)
  std::size_t columns = 0, rows = 0;
  std::vector<std::uint8_t> labels;  ///< row by row
  std::string source;                ///< the file that they came from
  std::vector<PatternPart> parts;    ///< each with its label
};

}  // namespace mezzotint
