#include "measurement/texture/power_spectrum.h"

#include <cmath>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "tests/measurement/relief.h"

namespace mezzotint {
namespace {

constexpr double turn = 2.0 * std::numbers::pi;
const Grid grid{64, 48, Length::from_um(0.5), Length::from_um(2.0)};

HeightField periodic_wave(double kx, double ky, double amplitude_um) {
  return test::field_of(
      grid, [=](double c, double r) { return amplitude_um * std::sin(turn * (kx * c / 64.0 + ky * r / 48.0)); },
      Continuation::Periodic);
}

double power(const PowerSpectrum& s) {
  const double cell = 1.0 / (64.0 * 0.5) / (48.0 * 2.0);
  return cell * std::accumulate(s.density_um4.begin(), s.density_um4.end(), 0.0);
}

TEST(PowerSpectrum, IntegratesToTheMeanSquareHeight) {
  EXPECT_NEAR(power(power_spectrum(periodic_wave(5, -3, 0.8))), 0.5 * 0.64, 1e-7);  // Parseval; float heights
}

TEST(PowerSpectrum, HasAWaveAtItsOwnFrequency) {
  const PowerSpectrum s = power_spectrum(periodic_wave(5, -3, 0.8));
  EXPECT_NEAR(s.frequency_x_per_um(32 + 5), 5.0 / 32.0, 1e-15);
  const double line = s.density_um4[(24 - 3) * 64 + 32 + 5];
  EXPECT_NEAR(line / (32.0 * 96.0), 0.25 * 0.64, 1e-7);
  EXPECT_NEAR(s.density_um4[(24 + 3) * 64 + 32 - 5], line, 1e-6 * line);
  EXPECT_LT(s.density_um4[(24 + 3) * 64 + 32 + 5], 1e-9 * line);
}

TEST(PowerSpectrum, OfWhiteNoiseIsFlatAtVarianceTimesTheAreaOfASample) {
  const HeightField field = test::white_noise(test::micrometre_grid(256, 256), 12);
  const PowerSpectrum s = power_spectrum(field);
  // Densities are exponentially distributed; each stands twice, and the Hann window leaves a quarter of them
  // independent: four standard errors.
  const double independent = 256.0 * 256.0 / 8.0;
  EXPECT_NEAR(std::accumulate(s.density_um4.begin(), s.density_um4.end(), 0.0) / (256.0 * 256.0), 1.0,
              4.0 / std::sqrt(independent));
  // The outer half of the rows alone.
  EXPECT_NEAR(std::accumulate(s.density_um4.begin(), s.density_um4.begin() + 64 * 256, 0.0) / (64.0 * 256.0), 1.0,
              4.0 / std::sqrt(independent / 4.0));
}

TEST(AngularSpectrum, PutsAWaveInItsDirection) {
  // 5/32 and −3/96 cycles a µm: −11.3°, so 168.7°.
  const AngularSpectrum s = angular_spectrum(power_spectrum(periodic_wave(5, -3, 0.8)));
  EXPECT_NEAR(s.share[169], 1.0, 1e-6);
  EXPECT_NEAR(std::accumulate(s.share.begin(), s.share.end(), 0.0), 1.0, 1e-12);
}

TEST(PowerSpectrum, NeedsEverySample) {
  HeightField field = periodic_wave(1, 1, 1.0);
  field.at(3, 3) = test::missing;
  EXPECT_THROW((void)power_spectrum(field), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
