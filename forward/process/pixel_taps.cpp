#include "forward/process/pixel_taps.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mezzotint {

namespace {

constexpr double cut_sigmas = 5.0;

// Integral of the unit Gaussian from −∞ to z standard deviations, without the part that is cut off.
double cut_integral(double z) { return 0.5 * std::erf(std::clamp(z, -cut_sigmas, cut_sigmas) / std::numbers::sqrt2); }

PixelTaps taps_at(double position, double sigma_pixels) {
  if (sigma_pixels <= 0.0) return {0, {1.0F}};
  const double reach = cut_sigmas * sigma_pixels;
  const int first = static_cast<int>(std::floor(position - reach));
  const int last = static_cast<int>(std::ceil(position + reach)) - 1;
  const double whole = 2.0 * cut_integral(cut_sigmas);
  PixelTaps taps{first, {}};
  for (int pixel = first; pixel <= last; ++pixel) {
    const double share =
        cut_integral((pixel + 1 - position) / sigma_pixels) - cut_integral((pixel - position) / sigma_pixels);
    taps.weights.push_back(static_cast<float>(share / whole));
  }
  return taps;
}

}  // namespace

std::vector<PixelTaps> pixel_taps(double sigma_pixels, std::size_t subsamples) {
  std::vector<PixelTaps> all;
  for (std::size_t s = 0; s < subsamples; ++s) {
    const double position = (static_cast<double>(s) + 0.5) / static_cast<double>(subsamples);
    all.push_back(taps_at(position, sigma_pixels));
  }
  return all;
}

}  // namespace mezzotint
