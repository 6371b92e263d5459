#include "forward/process/pixel_taps.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mezzotint {

namespace {

constexpr double cut_sigmas = 5.0;

// Integral of the unit Gaussian from −∞ to z standard deviations, without the part that is cut off.
double cut_integral(double z) { return 0.5 * std::erf(std::clamp(z, -cut_sigmas, cut_sigmas) / std::numbers::sqrt2); }

// d/dσ of the integral up to x, times σ: −z·φ(z), z = x/σ. None of it where the cut moves along with σ.
double cut_integral_slope(double z) {
  if (std::abs(z) >= cut_sigmas) return 0.0;
  return -z * std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi);
}

template <class Integral>
PixelTaps taps_at(double position, double sigma_pixels, double scale, const Integral& integral) {
  const double reach = cut_sigmas * sigma_pixels;
  const int first = static_cast<int>(std::floor(position - reach));
  const int last = static_cast<int>(std::ceil(position + reach)) - 1;
  PixelTaps taps{first, {}};
  for (int pixel = first; pixel <= last; ++pixel) {
    const double share = integral((pixel + 1 - position) / sigma_pixels) - integral((pixel - position) / sigma_pixels);
    taps.weights.push_back(static_cast<float>(share * scale));
  }
  return taps;
}

template <class Integral>
std::vector<PixelTaps> all_taps(double sigma_pixels, std::size_t subsamples, double scale, const Integral& integral) {
  std::vector<PixelTaps> all;
  for (std::size_t s = 0; s < subsamples; ++s) {
    const double position = (static_cast<double>(s) + 0.5) / static_cast<double>(subsamples);
    all.push_back(taps_at(position, sigma_pixels, scale, integral));
  }
  return all;
}

}  // namespace

std::vector<PixelTaps> pixel_taps(double sigma_pixels, std::size_t subsamples) {
  if (sigma_pixels <= 0.0) return std::vector<PixelTaps>(subsamples, {0, {1.0F}});
  return all_taps(sigma_pixels, subsamples, 0.5 / cut_integral(cut_sigmas), cut_integral);
}

std::vector<PixelTaps> pixel_tap_slopes(double sigma_pixels, std::size_t subsamples) {
  if (sigma_pixels <= 0.0) return std::vector<PixelTaps>(subsamples, {0, {0.0F}});
  return all_taps(sigma_pixels, subsamples, 0.5 / cut_integral(cut_sigmas) / sigma_pixels, cut_integral_slope);
}

}  // namespace mezzotint
