#pragma once

#include "forward/base/quantity.h"
#include "forward/surface/height_field.h"
#include "measurement/texture/bearing_curve.h"

namespace mezzotint {

/// Functional parameters of ISO 25178-2 from the material ratio curve.
///
/// Units    Sk, Spk, Svk, Sxp in µm; Smr1, Smr2 in 1 (a ratio, not per cent); Vmp, Vmc, Vvc, Vvv in µm³/µm² (= ml/m²),
///          printed as µm.
/// Sk       the straight line through the two points 40 % of material ratio apart between which the curve falls least;
///          where several stretches fall equally little, the middle of them.
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
