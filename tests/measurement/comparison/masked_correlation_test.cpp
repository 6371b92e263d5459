#include "measurement/comparison/masked_correlation.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "forward/base/random.h"
#include "measurement/comparison/feature_scale.h"
#include "tests/measurement/comparison/cosine_relief.h"

namespace mezzotint {
namespace {

MaskedImage noise(std::size_t columns, std::size_t rows, std::uint64_t seed) {
  const RandomStream random(seed, RandomPurpose::Test);
  MaskedImage image{columns, rows, {}, {}};
  for (std::size_t k = 0; k < columns * rows; ++k) {
    const bool seen = random.uniform4(k, 1)[0] < 0.7;
    image.seen.push_back(seen ? 1.0 : 0.0);
    image.values.push_back(seen ? random.normal4(k)[0] : 0.0);
  }
  return image;
}

struct Pairs {
  double count = 0.0;
  double pearson = 0.0;
};

/// Pearson's r by its definition: means first, then products.
Pairs directly(const MaskedImage& f, const MaskedImage& g, std::ptrdiff_t dx, std::ptrdiff_t dy) {
  std::vector<std::pair<double, double>> both;
  for (std::size_t k = 0; k < f.values.size(); ++k) {
    const auto x = static_cast<std::ptrdiff_t>(k % f.columns) + dx;
    const auto y = static_cast<std::ptrdiff_t>(k / f.columns) + dy;
    if (x < 0 || y < 0 || x >= static_cast<std::ptrdiff_t>(g.columns) || y >= static_cast<std::ptrdiff_t>(g.rows))
      continue;
    const std::size_t other = static_cast<std::size_t>(y) * g.columns + static_cast<std::size_t>(x);
    if (f.seen[k] > 0.0 && g.seen[other] > 0.0) both.emplace_back(f.values[k], g.values[other]);
  }
  const auto n = static_cast<double>(both.size());
  double mf = 0.0, mg = 0.0, ff = 0.0, gg = 0.0, fg = 0.0;
  for (const auto& [a, b] : both) mf += a / n, mg += b / n;
  for (const auto& [a, b] : both) ff += (a - mf) * (a - mf), gg += (b - mg) * (b - mg), fg += (a - mf) * (b - mg);
  return {n, fg / std::sqrt(ff * gg)};
}

TEST(MaskedCorrelation, EqualsItsDefinitionAtEveryDisplacement) {
  // Sizes that differ, so that mixing up the ends of the map would show.
  const MaskedImage f = noise(7, 5, 1);
  const MaskedImage g = noise(12, 10, 2);
  const CorrelationMap map = MaskedCorrelation(g, f.columns, f.rows).with(f, 6);
  std::size_t compared = 0;
  for (std::size_t k = 0; k < map.correlation.size(); ++k) {
    const Pairs expected = directly(f, g, map.displacement_x(k), map.displacement_y(k));
    EXPECT_EQ(map.overlap[k], expected.count);
    // Round-off of sums of some 100 numbers of size 1 (1e-14), divided by variances that may be a tenth.
    const double pearson = expected.count >= 6 ? expected.pearson : 0.0;
    EXPECT_NEAR(map.correlation[k], pearson, 1e-11);
    compared += expected.count >= 6 ? 1 : 0;
  }
  EXPECT_GT(compared, 100U);
}

TEST(FeatureHalfWidth, IsASixthOfASinusoidsWavelength) {
  HeightField ridges(test::square_grid(240, 1.0), Continuation::Mirrored);
  for (std::size_t k = 0; k < ridges.heights_um().size(); ++k) {
    ridges.heights_um()[k] = static_cast<float>(std::sin(2.0 * std::numbers::pi * static_cast<double>(k % 240) / 36.0));
  }
  // cos 60° = ½; the answer is a whole number of samples, the first at or below.
  EXPECT_NEAR(feature_half_width_um(ridges), 6.0, 1.0);
}

TEST(MainLobe, OfRidgesRunsAlongThemAndEndsBeforeTheNext) {
  HeightField ridges(test::square_grid(120, 2.0), Continuation::Mirrored);
  for (std::size_t k = 0; k < ridges.heights_um().size(); ++k) {
    ridges.heights_um()[k] = static_cast<float>(std::sin(2.0 * std::numbers::pi * static_cast<double>(k % 120) / 20.0));
  }
  const MainLobe lobe(ridges);
  EXPECT_TRUE(lobe.holds(0.0, 100.0));
  EXPECT_TRUE(lobe.holds(6.0, 0.0));    // cos(360°·3/20) = 0.59
  EXPECT_FALSE(lobe.holds(9.0, 0.0));   // 5 samples: 0
  EXPECT_FALSE(lobe.holds(40.0, 0.0));  // the next ridge: 1 again, but not in one piece with this one
  EXPECT_FALSE(lobe.holds(0.0, 1e6));
}

TEST(Standardised, RefusesAFlatSurface) {
  EXPECT_THROW((void)standardised(HeightField(test::square_grid(8, 1.0), Continuation::Mirrored)), MethodError);
}

}  // namespace
}  // namespace mezzotint
