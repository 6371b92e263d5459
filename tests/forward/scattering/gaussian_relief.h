#pragma once

#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "forward/base/fft.h"
#include "forward/base/random.h"
#include "tests/forward/scattering/reliefs.h"

namespace mezzotint::test {

/// A periodic Gaussian random field on size × size cells, its autocorrelation exp(−r²/τ²) with τ in cells, scaled to
/// an RMS gradient: heights and slopes are jointly Gaussian, unlike those of `random_relief`, whose waves are few.
inline HeightField gaussian_relief(std::size_t size, double gradient, double correlation_length,
                                   std::uint64_t seed = 1) {
  RealFft2d fft(size, size);
  const RandomStream random(seed, RandomPurpose::Test);
  const auto white = fft.real();
  for (std::size_t k = 0; k < white.size(); ++k) white[k] = random.normal4(k / 4)[k % 4];
  fft.forward();
  const double per_size = std::numbers::pi * correlation_length / static_cast<double>(size);
  for (std::size_t row = 0; row < size; ++row) {
    const double ky = row <= size / 2 ? static_cast<double>(row) : static_cast<double>(row) - static_cast<double>(size);
    for (std::size_t column = 0; column < fft.spectrum_columns(); ++column) {
      const auto kx = static_cast<double>(column);
      // The root of the power spectrum exp(−π² k² τ²) of exp(−r²/τ²).
      const double filter = kx == 0.0 && ky == 0.0 ? 0.0 : std::exp(-0.5 * per_size * per_size * (kx * kx + ky * ky));
      fft.spectrum()[row * fft.spectrum_columns() + column] *= filter;
    }
  }
  fft.inverse();
  const auto heights = fft.real();
  HeightField field = relief(size, size, Continuation::Periodic, [&](double c, double r) {
    return heights[static_cast<std::size_t>(r) * size + static_cast<std::size_t>(c)];
  });
  const double scale = gradient / rms_gradient(field);
  for (float& z : field.heights_um()) z = static_cast<float>(z * scale);
  return field;
}

}  // namespace mezzotint::test
