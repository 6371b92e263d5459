#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

#include "forward/process/cure_curve.h"

/// Inside of forward/process: the cure curve, many values at a time.

namespace mezzotint {

// Natural logarithm of a positive normal number to 1e-7: the library's, called a million times, costs more
// than all the rest of the process; the compiler runs this one on several values at a time.
// Source: the single-precision logarithm of the Cephes library (S. L. Moshier); mantissa in [√½, √2).
inline float fast_log(float x) {
  constexpr std::int32_t bits_of_root_half = 0x3f3504f3;
  const auto bits = std::bit_cast<std::int32_t>(x);
  const std::int32_t exponent = (bits - bits_of_root_half) >> 23;
  const float f = std::bit_cast<float>(bits - exponent * (1 << 23)) - 1.0F;
  float p = 7.0376836292e-2F;
  p = p * f - 1.1514610310e-1F;
  p = p * f + 1.1676998740e-1F;
  p = p * f - 1.2420140846e-1F;
  p = p * f + 1.4249322787e-1F;
  p = p * f - 1.6668057665e-1F;
  p = p * f + 2.0000714765e-1F;
  p = p * f - 2.4999993993e-1F;
  p = p * f + 3.3333331174e-1F;
  const float square = f * f;
  const auto e = static_cast<float>(exponent);
  // ln 2 in two parts, so that e·ln 2 loses nothing.
  const float low = p * f * square - 2.12194440e-4F * e - 0.5F * square;
  return f + low + 0.693359375F * e;
}

// The numbers of a cure curve as the inner loop wants them.
struct FastCure {
  float alpha_um, beta_um, gamma, threshold, least_dose, ceiling_um;
};

inline FastCure fast_cure(const CureCurve& curve, Length ceiling) {
  const double least = std::exp(-(curve.alpha / curve.beta));
  const float smallest = std::numeric_limits<float>::min();
  return {static_cast<float>(curve.alpha.um()),
          static_cast<float>(curve.beta.um()),
          static_cast<float>(curve.gamma),
          static_cast<float>(threshold_gray(curve)),
          std::max(static_cast<float>(least), smallest),
          static_cast<float>(ceiling.um())};
}

// Light to cured height, in place, without a branch.
inline void cure(std::span<float> row, const FastCure& curve) {
  float* const values = row.data();
  const std::size_t count = row.size();
  for (std::size_t i = 0; i < count; ++i) {
    const float gray = values[i];
    const float dose = gray - curve.gamma;
    const float height = curve.alpha_um + curve.beta_um * fast_log(dose > curve.least_dose ? dose : curve.least_dose);
    const float low = height > 0.0F ? height : 0.0F;
    const float cut = low < curve.ceiling_um ? low : curve.ceiling_um;
    values[i] = gray > curve.threshold ? cut : 0.0F;
  }
}

}  // namespace mezzotint
