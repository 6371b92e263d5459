#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "forward/process/cure_curve.h"

namespace mezzotint {

/// A layer of a stack, but for its picture.
struct StackLayer {
  Length thickness;
  double exposure = 1.0;  ///< how long it is lit, in the profile's own exposures
};

/// What a layer of this thickness lets through to the ones below: e^(−τ/β); 17 % of 18 µm at the slides' β.
[[nodiscard]] float passing_share(Length thickness, const CureCurve& curve);

/// The dose that a stack of layers has received, followed from its last layer down into the part.
///
/// Model    Light enters a layer at its upper face, the one at the window, and goes on down through everything that was
///          printed before: a layer of dose D there gives D·e^(−z/β) at the depth z below, whether that is resin or
///          solid. Doses add up, and resin is solid where their sum reaches the critical e^(−α/β). In layer j it is
///          A_j·e^(−z/β) with A_j = k_j (I_j − γ) + e^(−τ_(j+1)/β) A_(j+1), the sum at its upper face:
///          so the upper min(τ_j, α + β ln A_j) of the layer is solid. One number a column, whatever the layers.
/// Reduces  to `gray_to_height` for one layer, to the bit. k times the exposure moves α by β ln k.
/// Stray    light (−γ) is in every layer, in dark pixels too: it adds up to at most −γ/(1 − e^(−τ/β)).
/// Beyond   the last layer printed there is no light. Left out: bleaching, scattering in the resin, other attenuation
///          in solid than in resin (doses are then not additive), and what the platform reflects.
/// Shape    any number of columns (samples), always in the same order.
/// Units    doses in those of full gray at the profile's exposure; thicknesses in µm.
/// Accuracy thicknesses to 1e-5 µm (float and `fast_log`).
/// Source   Jacobs 1992 (β is the depth of penetration); Frisvad 2019, slide "Gray-scale calibration".
class DepthDose {
public:
  /// @throws InvalidInput for an invalid curve.
  DepthDose(const CureCurve& curve, std::size_t samples);

  /// Goes on to the next layer below; the first call is for the layer that is printed last.
  /// @param light  gray values that arrive, one a sample (see `spread_light`)
  /// @throws InvalidInput for a thickness or an exposure that is not positive, or another number of samples.
  void descend(const StackLayer& layer, std::span<const float> light);

  /// A_j: the dose at the upper face of the layer that was added last.
  [[nodiscard]] std::span<const float> dose() const { return dose_; }
  /// The solid thickness at the upper end of that layer, 0 … its own thickness.
  void cured_um(std::span<float> out) const;
  /// The same beyond the layer's own thickness: how deep the solid would reach if the layers below stayed dark.
  void reach_um(std::span<float> out) const;

private:
  void cure_into(std::span<float> out, float ceiling_um) const;

  CureCurve curve_;
  Length thickness_;  ///< of the layer that was added last
  bool is_empty_ = true;
  std::vector<float> dose_;
};

/// A solid stretch of a column, over the platform.
struct SolidInterval {
  Length lower, upper;
};

/// The solid stretches of one column, from the platform up; those that touch are one.
/// @param layers    from the platform up
/// @param cured_um  solid thickness at the upper end of each layer
/// @throws InvalidInput for another number of thicknesses, or one outside of its layer (by more than 1e-4 µm).
[[nodiscard]] std::vector<SolidInterval> solid_intervals(std::span<const StackLayer> layers,
                                                         std::span<const float> cured_um);

}  // namespace mezzotint
