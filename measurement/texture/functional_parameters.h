#pragma once

#include "forward/base/quantity.h"
#include "forward/surface/height_field.h"
#include "measurement/texture/bearing_curve.h"

namespace mezzotint {

/// Functional parameters of ISO 25178-2 from the material ratio curve.
///
/// Units    Sk, Spk, Svk, Sxp in µm; Smr1, Smr2 in 1 (a ratio, not per cent); Vmp, Vmc, Vvc, Vvv in µm³/µm² (= ml/m²),
///          printed as µm.
/// Sk       fall of the equivalent straight line over all material ratios: the line of least squares (in the direction
///          of the heights) through the stretch of 40 % over which the curve falls least; where neighbouring stretches
///          fall equally little, the middle of them. A curve that is not S-shaped (a sine's is steepest in its middle)
///          has its flattest stretch at an end, or at both: Smr1, Smr2, Spk and Svk then hang on rounding.
/// Settings Smr1, Smr2 from that line; volumes at 10 % and 80 %; Sxp from 2.5 % to 50 %: the standard's defaults.
/// Standard errors: delete-one-block jackknife over 16 blocks.
/// Source   ISO 25178-2:2021, 4.4 and annex; ISO 13565-2 for the line.
struct FunctionalParameters {
  Quantity Sk, Spk, Svk, Smr1, Smr2;
  Quantity Vmp, Vmc, Vvc, Vvv;
  Quantity Sxp;
};

/// @throws InvalidInput where fewer than four samples are measured.
[[nodiscard]] FunctionalParameters functional_parameters(const HeightField& field);

}  // namespace mezzotint
