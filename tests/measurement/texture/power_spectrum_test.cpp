#include "measurement/texture/power_spectrum.h"

#include <algorithm>
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
  const RadialSpectrum radial = radial_spectrum(power_spectrum(field));
  double chi = 0.0, rings = 0.0;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const RadialSpectrum draw = radial_spectrum(power_spectrum(test::white_noise(field.grid(), 300 + seed)));
    for (std::size_t k = 8; k < 128; ++k) {
      chi += std::pow((draw.density_um4[k] - 1.0) / draw.standard_error_um4[k], 2);
      rings += 1.0;
    }
  }
  // Neighbouring rings share a part of their power by the window: 960 of them count as about 500, √(2/500) = 6 %, and
  // rings of few frequencies know their own scatter poorly (they give 1.1 together).
  EXPECT_NEAR(chi / rings, 1.05, 0.25);
  EXPECT_NEAR(std::accumulate(radial.density_um4.begin() + 20, radial.density_um4.begin() + 120, 0.0) / 100.0, 1.0,
              0.02);
}

TEST(AngularSpectrum, PutsAWaveInItsDirection) {
  // 5/32 and −3/96 cycles a µm: −11.3°, so 168.7°.
  const AngularSpectrum s = angular_spectrum(power_spectrum(periodic_wave(5, -3, 0.8)));
  EXPECT_EQ(std::ranges::max_element(s.share) - s.share.begin(), 169);
  EXPECT_NEAR(std::accumulate(s.share.begin(), s.share.end(), 0.0), 1.0, 1e-12);
  // A cell of the spectrum is hypot(5, 3)/(32·96)/((5/32)² + (3/96)²) = 0.075 wide there, 4.3° each way, or a little
  // more where it is near.
  EXPECT_GT(std::accumulate(s.share.begin() + 163, s.share.begin() + 176, 0.0), 0.995);
}

TEST(AngularSpectrum, OfAnIsotropicSpectrumIsEven) {
  // exp(−f²/f₀²), of 3 to 48 waves a side, also where the field is not square. What is left is that each frequency
  // near the middle counts most in its own direction, so that a single wave has that: along the axes 8 % for 3 waves
  // a side, 4 % for 6 (19 and 7 % in a field that is longer than wide).
  for (const std::size_t rows : {128U, 90U})
    for (const double waves : {3.0, 6.0, 12.0, 48.0}) {
      PowerSpectrum s{128, rows, Length::from_um(1.0), Length::from_um(1.0), std::vector<double>(128 * rows)};
      for (std::size_t row = 0; row < rows; ++row)
        for (std::size_t column = 0; column < 128; ++column) {
          const double f = 128.0 / waves * std::hypot(s.frequency_x_per_um(column), s.frequency_y_per_um(row));
          s.density_um4[row * 128 + column] = std::exp(-f * f);
        }
      const AngularSpectrum angular = angular_spectrum(s, {.most_per_um = 0.5});
      for (const double share : angular.share) EXPECT_NEAR(180.0 * share, 1.0, waves < 6.0 ? 0.2 : 0.08) << waves;
    }
}

TEST(AngularSpectrum, LeavesOutWhatIsBeyondItsLimits) {
  const PowerSpectrum s = power_spectrum(periodic_wave(5, -3, 0.8));
  const double f = std::hypot(5.0 / 32.0, 3.0 / 96.0);
  EXPECT_NEAR(angular_power_share(s, {.least_per_um = 0.99 * f, .most_per_um = 1.01 * f}), 1.0, 1e-6);
  EXPECT_NEAR(angular_power_share(s, {.least_per_um = 1.01 * f}), 0.0, 1e-6);
  EXPECT_THROW((void)angular_spectrum(power_spectrum(HeightField(grid, Continuation::Periodic))), InvalidInput);
}

TEST(PowerSpectrum, NeedsEverySample) {
  HeightField field = periodic_wave(1, 1, 1.0);
  field.at(3, 3) = test::missing;
  EXPECT_THROW((void)power_spectrum(field), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
