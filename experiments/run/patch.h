#pragma once

#include "experiments/configuration/experiment_file.h"
#include "forward/surface/height_field.h"

namespace mezzotint {

/// Pixels along each edge of a patch that the dark surround or the mirror reaches by the blur; they are left
/// out of every comparison.
inline constexpr std::size_t edge_pixels = 2;

/// The patch of a print without its margin and edge, from a relief that covers the whole picture.
[[nodiscard]] HeightField inner_patch_of_picture(const HeightField& picture, const Experiment& experiment);
/// The same part, from a relief that covers the patch alone.
[[nodiscard]] HeightField inner_patch(const HeightField& patch, const Experiment& experiment);

/// The largest centred part of a field that the measurement covers, and how many samples were cut on each side.
/// Covered: missing are at most 1 % more than in the middle, where single samples drop out too.
struct CoveredPart {
  HeightField field;
  std::size_t inset = 0;
};
/// @throws MethodError where there is no such part of at least 16 × 16 samples, or a quarter of the middle is missing.
[[nodiscard]] CoveredPart covered_part(const HeightField& field);

}  // namespace mezzotint
