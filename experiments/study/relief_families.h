#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "forward/surface/height_field.h"

namespace mezzotint {

/// What tells one relief of a family from another.
struct ReliefDraw {
  std::size_t cells = 512;  ///< a side; 1 µm each
  std::uint64_t seed = 1;   ///< of what is random in it
  double periods = 16.0;    ///< a side, whole; of random reliefs: the fewest
  double skew = 0.5;        ///< of skewed ridges: where the crest stands in a period, in (0, 1)
};

/// A relief of a family, heights in any unit: it is scaled to an RMS gradient afterwards (make_study_relief).
///
/// Periodic  "gaussian" (random waves), "noise" (sparse convolution noise), "sinusoid" (sin·sin), "ridges"
/// (triangular), "skewed ridges", "bumps" (three
///           octaves of sparse random bumps: noise whose slopes are far from Gaussian), "folds" (|random waves|: sharp
///           valleys), "plateaus" (random waves pressed to two levels: flat, with steep steps)
/// Mirrored  "patch": random waves that do not fit the tile, as of a scan
/// @throws   InvalidInput for another family.
[[nodiscard]] HeightField draw_relief(const std::string& family, const ReliefDraw& draw);

/// The names that draw_relief understands.
[[nodiscard]] const std::vector<std::string>& relief_families();

}  // namespace mezzotint
