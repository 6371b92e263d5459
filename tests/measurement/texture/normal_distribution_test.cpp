#include "measurement/texture/normal_distribution.h"

#include <cmath>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>

#include "tests/measurement/relief.h"

namespace mezzotint {
namespace {

double total(const NormalDistribution& d) {
  const auto areas = projected_solid_angles(d.grid);
  return std::inner_product(areas.begin(), areas.end(), d.distribution.begin(), 0.0);
}

TEST(NormalDistribution, OfAnyReliefCoversThePlaneOnce) {
  EXPECT_NEAR(total(normal_distribution(test::white_noise(test::micrometre_grid(40, 30), 2))), 1.0, 1e-12);
}

TEST(NormalDistribution, OfAPlaneIsItsNormal) {
  // Slope ½ along x: the normal (−½, 0, 1)/√1.25 looks back, at x = −0.447.
  const NormalDistribution d = normal_distribution(
      test::field_of(test::micrometre_grid(20, 20), [](double c, double) { return 0.5 * c; }), {64, 64});
  const std::size_t bin = d.grid.bin_of(-0.5 / std::sqrt(1.25), 0.0);
  EXPECT_NEAR(d.distribution[bin] * 4.0 / 64.0 / 64.0, 1.0, 1e-12);
}

TEST(NormalDistribution, OfASineIsTheArcsineLaw) {
  // Slopes S cos φ with φ even: P(slope > s) = ½ − asin(s/S)/π, and a normal at x looks back from a slope of
  // −x/√(1 − x²). 4096 samples a wave; the chords of the facets have a steepest slope of S sin(π/n)/(π/n).
  constexpr std::size_t n = 4096;
  constexpr double steepest = 0.8;
  const Grid grid{n, 4, Length::from_um(0.01), Length::from_um(1.0)};
  const NormalDistribution d =
      normal_distribution(test::field_of(
                              grid,
                              [](double c, double) {
                                return steepest * 0.01 * n / (2.0 * std::numbers::pi) *
                                       std::sin(2.0 * std::numbers::pi * (c + 0.25) / static_cast<double>(n));
                              },
                              Continuation::Periodic),
                          {64, 64});
  const std::vector<double> areas = projected_solid_angles(d.grid);
  double share = 0.0;
  for (std::size_t column = 0; column < 64; ++column) {
    const double edge = static_cast<double>(column) / 32.0 - 1.0;  // the left one of this column
    const double slope = edge / std::sqrt(1.0 - edge * edge);
    if (std::abs(slope) < 0.9 * steepest) {
      // One facet in 4096 may lie on the other side of an edge, at two places of a wave.
      EXPECT_NEAR(share, 0.5 + std::asin(slope / steepest) / std::numbers::pi, 2.5 / n) << edge;
    }
    for (std::size_t row = 0; row < 64; ++row) share += d.distribution[row * 64 + column] * areas[row * 64 + column];
  }
  EXPECT_NEAR(share, 1.0, 1e-12);
  EXPECT_NEAR(d.kurtosis_major.value, 1.5, 1e-5);
}

TEST(NormalDistribution, KnowsTwoSlopesFromManyByTheirKurtosis) {
  // Ridges of slope ±1 have fourth moments equal to the second's square; along the crests there is nothing.
  const NormalDistribution d = normal_distribution(test::field_of(
      test::micrometre_grid(64, 16), [](double c, double) { return std::abs(std::remainder(c, 16.0)); },
      Continuation::Periodic));
  EXPECT_NEAR(d.axes.rms_major, 1.0, 1e-7);
  EXPECT_NEAR(d.kurtosis_major.value, 1.0, 1e-7);
  EXPECT_NEAR(d.axes.rotation.degrees(), 0.0, 1e-9);
  EXPECT_EQ(d.shortest_um, 2.0);
  EXPECT_EQ(d.longest_um, 64.0);
  const NormalDistribution noise = normal_distribution(test::white_noise(test::micrometre_grid(256, 256), 7));
  // Differences of Gaussian heights are Gaussian; 65000 of them give ±√(24/n) = 0.02, twice counted.
  EXPECT_NEAR(noise.kurtosis_major.value, 3.0, 0.1);
}

}  // namespace
}  // namespace mezzotint
