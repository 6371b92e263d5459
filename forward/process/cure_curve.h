#pragma once

#include "forward/base/units.h"

namespace mezzotint {

/// The working curve of a photopolymer under gray light: height = α + β ln(I − γ) above the threshold
/// I₀ = e^(−α/β) + γ, else 0; I the gray value in [0, 1].
///
/// Units    α, β lengths; γ a gray value. β is Jacobs' penetration depth, γ the stray light (negative).
/// Source   Frisvad 2019, slide "Gray-scale calibration"; Jacobs 1992. Defaults: the slides' printer.
struct CureCurve {
  Length alpha = Length::from_um(17.71);
  Length beta = Length::from_um(10.24);
  double gamma = -0.01;
};

/// @throws InvalidInput for β ≤ 0, γ ≥ 1 or a threshold outside of [0, 1).
void require_valid(const CureCurve& curve);

/// The gray value at which curing begins.
[[nodiscard]] double threshold_gray(const CureCurve& curve);
/// Cured height of a gray value (any value ≥ 0; over 1 means more light than full gray).
[[nodiscard]] Length gray_to_height(const CureCurve& curve, double gray);
/// The gray value that cures to a height > 0; above 1 where full gray does not reach it (the caller says
/// so, it is not cut here); 0 for a height ≤ 0.
[[nodiscard]] double height_to_gray(const CureCurve& curve, Length height);

/// The curve when light shines `factor` times as long (or as strong): α grows by β ln(factor).
/// @throws InvalidInput for a factor that is not positive, or one that makes the curve invalid.
[[nodiscard]] CureCurve scale_exposure(const CureCurve& curve, double factor);

}  // namespace mezzotint
