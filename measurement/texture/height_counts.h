#pragma once

#include <vector>

#include "measurement/texture/bearing_curve.h"

/// Inside of measurement/texture.

namespace mezzotint {

/// The heights of each of the 16 blocks, counted in the same bins; empty for a field of no more measured samples than a
/// curve sorts, and for one whose heights fill less than a sixteenth of the bins.
[[nodiscard]] std::vector<HeightCounts> counts_in_blocks(const HeightField& field);
[[nodiscard]] HeightCounts sum_of(const std::vector<HeightCounts>& blocks);

}  // namespace mezzotint
