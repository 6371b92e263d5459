#pragma once

#include <string>

#include "forward/base/quantity.h"
#include "forward/surface/height_field.h"

namespace mezzotint {

/// Spatial parameters of ISO 25178-2.
///
/// Sal   shortest way from the middle of the autocorrelation to where it first falls to 0.2 (µm).
/// Str   that way divided by the longest one, 0 … 1: 1 for a texture that is alike in all directions.
/// Std   direction of the wave vector that holds the most power (degrees from +x, counter-clockwise, [0°, 180°)):
/// across
///       the lay, like `direction_deg` of ridges. Means nothing where Str is near 1.
/// Ends  where the autocorrelation does not fall to 0.2 within half of the field in some direction, the longest way is
///       at least that half: Str is then an upper bound, said in `note`. Where it falls in none, Sal is NaN.
/// Lay   that turns across the field gives a Str near 1 of parts that are directional each; said in `note` where Str is
///       2.5 times its mean over 16 blocks.
/// Standard errors: delete-one-block jackknife over 16 blocks, each with the pairs within it, so only where Sal is
///       below a quarter of a block's side; NaN elsewhere.
/// Source ISO 25178-2:2021, 4.2, with the threshold 0.2.
struct SpatialParameters {
  Quantity Sal, Str, Std;
  std::string note;
};

/// @param field  levelled; a patch with missing samples has no Std (NaN): fill them first
/// @throws InvalidInput for a flat field or one of fewer than 16 × 16 samples.
[[nodiscard]] SpatialParameters spatial_parameters(const HeightField& field);

}  // namespace mezzotint
