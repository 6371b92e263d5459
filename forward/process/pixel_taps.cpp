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

// The integrand, which is the slope toward the place: minus, since the pixels move the other way.
double cut_density(double z) {
  return std::abs(z) < cut_sigmas ? -std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi) : 0.0;
}

double antiderivative(TapKind kind, double z) {
  if (kind == TapKind::Value) return cut_integral(z);
  return kind == TapKind::WidthSlope ? cut_integral_slope(z) : cut_density(z);
}

PixelTaps taps_at(TapKind kind, double position, double sigma_pixels) {
  const double reach = cut_sigmas * sigma_pixels;
  const double whole = 2.0 * cut_integral(cut_sigmas) * (kind == TapKind::Value ? 1.0 : sigma_pixels);
  const int first = static_cast<int>(std::floor(position - reach));
  const int last = static_cast<int>(std::ceil(position + reach)) - 1;
  PixelTaps taps{first, {}};
  for (int pixel = first; pixel <= last; ++pixel) {
    const double share = antiderivative(kind, (pixel + 1 - position) / sigma_pixels) -
                         antiderivative(kind, (pixel - position) / sigma_pixels);
    taps.weights.push_back(static_cast<float>(share / whole));
  }
  return taps;
}

}  // namespace

std::vector<PixelTaps> pixel_taps(TapKind kind, double sigma_pixels, std::size_t subsamples, double place) {
  if (sigma_pixels <= 0.0) return std::vector<PixelTaps>(subsamples, {0, {kind == TapKind::Value ? 1.0F : 0.0F}});
  std::vector<PixelTaps> all;
  for (std::size_t s = 0; s < subsamples; ++s)
    all.push_back(taps_at(kind, (static_cast<double>(s) + place) / static_cast<double>(subsamples), sigma_pixels));
  return all;
}

}  // namespace mezzotint
