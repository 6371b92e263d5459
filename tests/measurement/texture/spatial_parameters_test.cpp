#include "measurement/texture/spatial_parameters.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "measurement/texture/autocorrelation.h"
#include "measurement/texture/power_spectrum.h"
#include "tests/measurement/relief.h"

namespace mezzotint {
namespace {

constexpr double pi = std::numbers::pi;

// White noise smeared by Gaussians of widths a and b samples: f_ACF = exp(−x²/(4a²) − y²/(4b²)).
HeightField smeared(std::size_t side, double a, double b, std::uint64_t seed) {
  const HeightField noise = test::white_noise(test::micrometre_grid(side, side), seed);
  HeightField rows(noise.grid(), Continuation::Periodic), both = rows;
  const auto n = static_cast<std::ptrdiff_t>(side);
  const auto smear = [n](const HeightField& from, HeightField& to, double width, bool along_x) {
    const auto reach = static_cast<std::ptrdiff_t>(std::ceil(5.0 * width));
    for (std::ptrdiff_t r = 0; r < n; ++r)
      for (std::ptrdiff_t c = 0; c < n; ++c) {
        double sum = 0.0;
        for (std::ptrdiff_t k = -reach; k <= reach; ++k) {
          const std::ptrdiff_t x = along_x ? (c + k + n) % n : c, y = along_x ? r : (r + k + n) % n;
          sum += std::exp(-0.5 * static_cast<double>(k * k) / (width * width)) *
                 static_cast<double>(from.at(static_cast<std::size_t>(x), static_cast<std::size_t>(y)));
        }
        to.at(static_cast<std::size_t>(c), static_cast<std::size_t>(r)) = static_cast<float>(sum);
      }
  };
  smear(noise, rows, a, true);
  smear(rows, both, b, false);
  return both;
}

TEST(Autocorrelation, OfEveryPairIsTheDefinition) {
  HeightField field = test::white_noise(test::micrometre_grid(13, 10), 3);
  field.at(4, 5) = field.at(0, 0) = field.at(12, 9) = test::missing;
  const Autocorrelation f = autocorrelation(field);
  double mean = 0.0, count = 0.0, variance = 0.0;
  for (const float z : field.heights_um())
    if (!std::isnan(z)) {
      mean += static_cast<double>(z);
      count += 1.0;
    }
  mean /= count;
  for (const float z : field.heights_um())
    if (!std::isnan(z)) variance += std::pow(static_cast<double>(z) - mean, 2) / count;
  for (const auto& [tx, ty] : {std::pair<std::ptrdiff_t, std::ptrdiff_t>{0, 0}, {1, 0}, {-6, 5}, {3, -2}, {6, 5}}) {
    double sum = 0.0, pairs = 0.0;
    for (std::ptrdiff_t r = 0; r < 10; ++r)
      for (std::ptrdiff_t c = 0; c < 13; ++c) {
        if (c + tx < 0 || c + tx >= 13 || r + ty < 0 || r + ty >= 10) continue;
        const double here = field.at(static_cast<std::size_t>(c), static_cast<std::size_t>(r));
        const double there = field.at(static_cast<std::size_t>(c + tx), static_cast<std::size_t>(r + ty));
        if (std::isnan(here) || std::isnan(there)) continue;
        sum += (here - mean) * (there - mean);
        pairs += 1.0;
      }
    EXPECT_NEAR(f.at(tx, ty), sum / pairs / variance, 1e-12) << tx << ' ' << ty;
  }
}

TEST(SpatialParameters, OfAGaussianAutocorrelationAreTheClosedForm) {
  // exp(−t²/4a²) falls to 0.2 at 2a√(ln 5). A field of 384² holds some 730 independent patches
  // (∫f² = 2π·4·8): f is off by about 0.04 at 0.2, where it falls by 0.64 a Sal: 6 %.
  const SpatialParameters p = spatial_parameters(smeared(384, 4.0, 8.0, 11));
  const double sal = 2.0 * 4.0 * std::sqrt(std::log(5.0));
  EXPECT_NEAR(p.Sal.value, sal, 4.0 * *p.Sal.standard_error + 0.02);  // bilinear between lags: (1/4)²/8 of a sample
  EXPECT_LT(*p.Sal.standard_error, 0.1 * sal);
  EXPECT_NEAR(p.Str.value, 0.5, 4.0 * *p.Str.standard_error + 0.005);
  EXPECT_NEAR(std::remainder(p.Std.value, 180.0), 0.0, 30.0);  // steeper along x, in one draw
  EXPECT_EQ(p.note, "");
}

TEST(SpatialParameters, OfAnIsotropicTextureHaveARatioNearOne) {
  const SpatialParameters p = spatial_parameters(smeared(384, 5.0, 5.0, 5));
  EXPECT_GT(p.Str.value, 0.85);  // the shortest and the longest of 360 noisy ways
  EXPECT_LE(p.Str.value, 1.0);
}

TEST(SpatialParameters, OfWhiteNoiseHaveAnyDirection) {
  // Neither along the axes, where most frequencies of a square lattice lie, nor to its corners. And the stated error is
  // that of a direction which means nothing: a uniform one is 52° off.
  double quarters = 0.0, stated = 0.0;
  constexpr int draws = 24;
  for (int i = 0; i < draws; ++i) {
    const SpatialParameters p = spatial_parameters(test::white_noise(test::micrometre_grid(48, 48), 500 + i));
    quarters += std::abs(std::remainder(p.Std.value, 90.0)) < 22.5 ? 1.0 : 0.0;
    stated += *p.Std.standard_error / draws;
  }
  EXPECT_NEAR(quarters / draws, 0.5, 4.0 * 0.5 / std::sqrt(draws));
  EXPECT_NEAR(stated, 52.0, 5.0);
}

// The autocorrelation of a periodic field is a sum of cosines, known between lags too: where it first falls to 0.2, by
// a march of small steps along every whole degree, and every hundredth of one beside the best.
class SumOfCosines {
public:
  explicit SumOfCosines(const HeightField& field) : spectrum_(power_spectrum(field)) {
    for (double& density : spectrum_.density_um4) total_ += density;
  }
  [[nodiscard]] double way(double degrees) const {
    const double c = std::cos(degrees * pi / 180.0), s = std::sin(degrees * pi / 180.0);
    double low = 0.0;
    while (at((low + 0.25) * c, (low + 0.25) * s) > 0.2) low += 0.25;
    double high = low + 0.25;
    for (int i = 0; i < 24; ++i)
      (at(0.5 * (low + high) * c, 0.5 * (low + high) * s) > 0.2 ? low : high) = 0.5 * (low + high);
    return low;
  }

private:
  [[nodiscard]] double at(double x, double y) const {
    double sum = 0.0;
    for (std::size_t row = 0; row < spectrum_.rows; ++row)
      for (std::size_t column = 0; column < spectrum_.columns; ++column) {
        const double density = spectrum_.density_um4[row * spectrum_.columns + column];
        if (density < 1e-9 * total_) continue;  // 4096 of them change f by 4e-6
        sum += density *
               std::cos(2.0 * pi * (spectrum_.frequency_x_per_um(column) * x + spectrum_.frequency_y_per_um(row) * y));
      }
    return sum / total_;
  }
  PowerSpectrum spectrum_;
  double total_ = 0.0;
};

TEST(SpatialParameters, AreThoseOfTheAutocorrelationBetweenLagsToo) {
  const HeightField field = smeared(64, 3.0, 4.0, 21);
  const SumOfCosines f(field);
  double shortest = HUGE_VAL, longest = 0.0, at_shortest = 0.0, at_longest = 0.0;
  const auto look = [&](double degrees) {
    const double way = f.way(degrees);
    if (way < shortest) at_shortest = degrees;
    if (way > longest) at_longest = degrees;
    shortest = std::min(shortest, way);
    longest = std::max(longest, way);
  };
  for (int k = 0; k < 180; k += 2) look(k);
  for (const double around : {at_shortest, at_longest})
    for (int k = -100; k <= 100; k += 4) look(around + 0.02 * k);
  const SpatialParameters p = spatial_parameters(field);
  // Polynomials of the fifth degree between lags: 225/64/720 of the sixth derivative, 30/3^6 here, over a slope of 0.1.
  EXPECT_NEAR(p.Sal.value, shortest, 2e-3);
  EXPECT_NEAR(p.Str.value, shortest / longest, 4e-4);
}

TEST(SpatialParameters, KnowTheDirectionOfAWaveThatOneAxisAloneResolves) {
  // 0.75 waves a µm along x: above what samples 2 µm apart would resolve, as they are along y.
  const Grid grid{64, 48, Length::from_um(0.5), Length::from_um(2.0)};
  const HeightField field = test::field_of(
      grid, [](double c, double) { return std::cos(2.0 * pi * 24.0 * c / 64.0); }, Continuation::Periodic);
  EXPECT_EQ(spatial_parameters(field).Std.value, 0.0);
}

TEST(SpatialParameters, OfRidgesSayWhatTheyCannotKnow) {
  const double angle = 30.0 * pi / 180.0;
  const HeightField field = test::field_of(test::micrometre_grid(200, 200), [&](double c, double r) {
    return std::cos(2.0 * pi * (c * std::cos(angle) + r * std::sin(angle)) / 16.0);
  });
  const SpatialParameters p = spatial_parameters(field);
  // cos(2πt/16) = 0.2 at t = 3.487, across the crests.
  EXPECT_NEAR(p.Sal.value, 16.0 * std::acos(0.2) / (2.0 * pi), 0.03);
  EXPECT_NEAR(p.Std.value, 30.0, 1.0);  // the wave vector at +30° is at +30°
  EXPECT_NE(p.note.find("Str is at most"), std::string::npos);
  EXPECT_LT(p.Str.value, 0.04);
}

TEST(SpatialParameters, RefuseAFlatField) {
  EXPECT_THROW((void)spatial_parameters(HeightField(test::micrometre_grid(32, 32), Continuation::Mirrored)),
               InvalidInput);
  EXPECT_THROW((void)spatial_parameters(HeightField(test::micrometre_grid(8, 32), Continuation::Mirrored)),
               InvalidInput);
}

}  // namespace
}  // namespace mezzotint
