#pragma once

#include <cstddef>
#include <vector>

namespace mezzotint {

/// What the pixels around give to one sub-pixel position: pixel i receives weights[k] of pixel i + first + k.
struct PixelTaps {
  int first = 0;
  std::vector<float> weights;
};

/// The taps themselves; their derivative toward σ, a pixel of σ; and toward the place along the axis, a pixel of way.
enum class TapKind { Value, WidthSlope, PlaceSlope };

/// The taps of every sub-pixel position s, at (s + place)/subsamples of a pixel: integrals of a Gaussian of
/// `sigma_pixels` over the pixels around, cut at 5σ; values sum to 1, derivatives to 0. Without blur the pixel's own
/// value, and no derivative.
[[nodiscard]] std::vector<PixelTaps> pixel_taps(TapKind kind, double sigma_pixels, std::size_t subsamples,
                                                double place = 0.5);

}  // namespace mezzotint
