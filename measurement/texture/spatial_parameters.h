#pragma once

#include <string>
#include <vector>

#include "forward/base/quantity.h"
#include "forward/surface/height_field.h"
#include "measurement/texture/autocorrelation.h"

namespace mezzotint {

/// Spatial parameters of ISO 25178-2.
///
/// Sal   shortest way from the middle of the autocorrelation to where it first falls to 0.2 (µm).
/// Str   that way divided by the longest one, 0 … 1: 1 for a texture that is alike in all directions.
/// How   the autocorrelation is interpolated between lags by polynomials of the fifth degree, the shortest and the
///       longest way are sought between directions half a degree apart.
/// Std   direction of the wave vector that holds the most power (degrees from +x, counter-clockwise, [0°, 180°), in
///       steps of 1°): across the lay, like `direction_deg` of ridges. Means nothing where Str is near 1. Frequencies
///       beyond what both axes resolve are left out, unless most of the power is there.
/// Ends  where the autocorrelation does not fall to 0.2 within half of the field in some direction, the longest way is
///       at least that half: Str is then an upper bound, said in `note`. Where it falls in none, Sal is NaN.
/// Lay   that turns across the field gives a Str near 1 of parts that are directional each; said in `note` where Str is
///       2.5 times its mean over 16 blocks.
/// Standard errors: delete-one-block jackknife over 16 blocks, each with the pairs within it, so only where Sal is
///       below a quarter of a block's side; NaN elsewhere. Std: half its step, and the scatter of the blocks' own
///       directions about it, an upper bound. In 60 draws of Gaussian surfaces of 192² samples that of Sal was 0.7 of
///       the true scatter where the lay was long (Str = ½, Sal a sixth of a block), and right where there was none.
/// Source ISO 25178-2:2021, 4.2, with the threshold 0.2.
struct SpatialParameters {
  Quantity Sal, Str, Std;
  std::string note;
};

/// @param field  levelled; a patch with missing samples has no Std (NaN): fill them first
/// @throws InvalidInput for a flat field or one of fewer than 16 × 16 samples.
[[nodiscard]] SpatialParameters spatial_parameters(const HeightField& field);
/// The same where the field's autocorrelation is known.
[[nodiscard]] SpatialParameters spatial_parameters(const HeightField& field, const Autocorrelation& known);

/// How far the autocorrelation is above 0.2 from the middle on, in one direction.
struct Decay {
  Angle direction;
  double length_um = 0.0;
  bool reached = false;  ///< else the length is how far could be looked
};
/// In steps of half a degree over half a turn; the other half is its mirror image.
[[nodiscard]] std::vector<Decay> decays_of(const Autocorrelation& autocorrelation);

}  // namespace mezzotint
