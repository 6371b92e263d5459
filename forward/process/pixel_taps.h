#pragma once

#include <cstddef>
#include <vector>

namespace mezzotint {

/// What the pixels around give to one sub-pixel position: pixel i receives weights[k] of pixel i + first + k.
struct PixelTaps {
  int first = 0;
  std::vector<float> weights;
};

/// The taps of every sub-pixel position s, at (s + ½)/subsamples of a pixel: integrals of a Gaussian of
/// `sigma_pixels` over the pixels around, cut at 5σ, summing to 1. Without blur the pixel's own value.
[[nodiscard]] std::vector<PixelTaps> pixel_taps(double sigma_pixels, std::size_t subsamples);

/// Their derivatives toward σ, in 1/pixel, at the same places; zero without blur.
[[nodiscard]] std::vector<PixelTaps> pixel_tap_slopes(double sigma_pixels, std::size_t subsamples);

}  // namespace mezzotint
