#include "forward/pattern/noise_spectrum.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "forward/base/fft.h"
#include "forward/pattern/noise_scatter.h"
#include "forward/pattern/sparse_noise.h"

namespace mezzotint {
namespace {

// Over [−8, 8]², by the midpoint rule, which is exact for what is periodic and has a compact transform.
template <typename Weight>
double integral(const Weight& weight) {
  constexpr double step = 1.0 / 16.0;
  double sum = 0.0;
  for (int i = -128; i < 128; ++i) {
    for (int j = -128; j < 128; ++j) {
      const double x = (i + 0.5) * step, y = (j + 0.5) * step;
      sum += weight(x, y) * noise_spectral_density(x, y);
    }
  }
  return sum * step * step;
}

TEST(NoiseSpectrum, HoldsTheVarianceAndTheSlopesOfTheNoise) {
  // The constants are rounded to four digits.
  EXPECT_NEAR(integral([](double, double) { return 1.0; }), noise_variance_at_z0, 1e-5);
  const double square = 4.0 * std::numbers::pi * std::numbers::pi;
  EXPECT_NEAR(integral([square](double x, double y) { return square * (x * x + y * y); }),
              noise_plane_gradient_square_at_z0, 1e-4);
}

// Periodic tiles of 32 cells have a periodogram whose mean is the density itself. Each ring holds 32 frequencies or
// more, each of 16 tiles exponentially distributed: four standard errors, and a tenth more for what impulses that are
// not Gaussian scatter.
TEST(NoiseSpectrum, IsThatOfDrawnNoise) {
  constexpr std::size_t cells = 32, side = 256, tiles = 16, rings = 8;
  const Grid grid{side, side, Length::from_um(0.125), Length::from_um(0.125)};
  const Sheet sheet{grid, {}, Continuation::Periodic};
  std::vector<double> drawn(rings), expected(rings), count(rings);
  RealFft2d fft(side, side);
  for (std::uint64_t seed = 1; seed <= tiles; ++seed) {
    std::vector<float> values(side * side, 0.0F);
    add_sparse_noise(values, grid, {}, NoiseLattice(seed, CellHash::Integer, {}, sheet), 0.0, 1.0);
    std::ranges::copy(values, fft.real().begin());
    fft.forward();
    for (std::size_t ky = 0; ky < side; ++ky)
      for (std::size_t kx = 1; kx < side / 2; ++kx) {
        const double x = static_cast<double>(kx) / cells;
        const double y = (static_cast<double>(ky) - (ky > side / 2 ? static_cast<double>(side) : 0.0)) / cells;
        const auto ring = static_cast<std::size_t>(std::hypot(x, y) / 0.25);
        if (ring >= rings) continue;
        const double scale = 1.0 / 64.0 / 64.0 / cells / cells;
        drawn[ring] += scale * std::norm(fft.spectrum()[ky * fft.spectrum_columns() + kx]);
        expected[ring] += noise_spectral_density(x, y);
        count[ring] += 1.0;
      }
  }
  for (std::size_t ring = 0; ring < rings; ++ring)
    EXPECT_NEAR(drawn[ring] / expected[ring], 1.0, 4.4 / std::sqrt(count[ring])) << 0.25 * static_cast<double>(ring);
}

}  // namespace
}  // namespace mezzotint
