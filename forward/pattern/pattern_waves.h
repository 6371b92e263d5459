#pragma once

#include <cstddef>
#include <vector>

#include "forward/pattern/pattern.h"
#include "forward/pattern/pattern_map.h"

/// Inside of forward/pattern.

namespace mezzotint {

/// Whether the mean over the plane of a product of parts (or of their squares or slopes) is the product of their means.
///
/// Noises have seeds of their own. Two periodic parts are uncorrelated where no wave of one, or of its square, is
/// parallel to one of the other; where one is, the answer is no, though they may be so by chance.
/// @param most_periodic  more periodic parts than that count as correlated: three waves may close a triangle
[[nodiscard]] bool parts_are_uncorrelated(const std::vector<PatternPart>& parts, const Sheet& sheet,
                                          std::size_t most_periodic);

}  // namespace mezzotint
