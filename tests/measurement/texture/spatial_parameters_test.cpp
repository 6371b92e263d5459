#include "measurement/texture/spatial_parameters.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "measurement/texture/autocorrelation.h"
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
  constexpr int draws = 80;
  for (int i = 0; i < draws; ++i) {
    const SpatialParameters p = spatial_parameters(test::white_noise(test::micrometre_grid(64, 64), 500 + i));
    quarters += std::abs(std::remainder(p.Std.value, 90.0)) < 22.5 ? 1.0 : 0.0;
    stated += *p.Std.standard_error / draws;
  }
  EXPECT_NEAR(quarters / draws, 0.5, 4.0 * 0.5 / std::sqrt(draws));
  EXPECT_NEAR(stated, 52.0, 5.0);
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
