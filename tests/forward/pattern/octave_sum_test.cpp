#include "forward/pattern/octave_sum.h"

#include <cmath>

#include <gtest/gtest.h>

#include "forward/pattern/pattern.h"
#include "forward/pattern/sparse_noise.h"
#include "tests/forward/pattern/draws.h"

namespace mezzotint {
namespace {

using test::expect_drawn;
using test::mean_height;
using test::mean_square_about;
using test::over_draws;
using test::square_grid;

TEST(FractionalBrownianMotion, OfOneOctaveIsNoise) {
  const HeightField noise =
      synthesize(Noise{.scale = 50.0_um, .stretch = 2.0, .direction = 20.0_deg}, square_grid(64, 3.0));
  const HeightField motion =
      synthesize(FractionalBrownianMotion{.scale = 50.0_um, .stretch = 2.0, .direction = 20.0_deg, .octaves = 1},
                 square_grid(64, 3.0));
  EXPECT_TRUE(std::ranges::equal(noise.heights_um(), motion.heights_um()));
}

TEST(FractionalBrownianMotion, HasItsClosedFormVarianceAndSlopes) {
  const Pattern motion = FractionalBrownianMotion{
      .scale = 128.0_um, .stretch = 2.0, .height = 10.0_um, .hurst = 0.6, .lacunarity = 2.0, .octaves = 3};
  const SlopeCovariance expected = closed_form_slope_covariance(motion).value();
  const auto drawn = over_draws(motion, square_grid(1024, 1.0), 12, [](const HeightField& field) {
    const SlopeCovariance slopes = slope_covariance(field);
    return std::vector{mean_square_about(field, 5.0), slopes.xx, slopes.yy};
  });
  // The deviation is that of noise, whatever the octaves. The cut takes 0.1 % of the samples and 0.5 % of the variance.
  expect_drawn(drawn[0], 100.0 * noise_variance_at_z0, 0.01, "variance");
  // Differences over 1/32 of the finest cell lose 0.3 % of its slopes; what is cut is flat.
  expect_drawn(drawn[1], expected.xx, 0.01, "xx");
  expect_drawn(drawn[2], expected.yy, 0.01, "yy");
}

// E (h(x + r) − h(x))², along rows.
double structure_function(const HeightField& field, std::size_t lag) {
  double sum = 0.0, count = 0.0;
  for (std::size_t row = 0; row < field.rows(); row += 2) {
    for (std::size_t column = 0; column + lag < field.columns(); ++column) {
      const double difference = static_cast<double>(field.at(column + lag, row)) - field.at(column, row);
      sum += difference * difference;
      count += 1.0;
    }
  }
  return sum / count;
}

TEST(FractionalBrownianMotion, GrowsByItsHurstExponent) {
  for (const double hurst : {0.3, 0.6}) {
    const Pattern motion = FractionalBrownianMotion{.scale = 512.0_um, .hurst = hurst, .lacunarity = 2.0, .octaves = 8};
    // Lags of 8 to 32 samples lie between cells of 4 and of 512: there S(r) ~ r^2H but for the octaves that are not
    // there. By the sum Σ w² (1 − ρ(r/L)) the finer ones would add up to 22 % at the smallest lag (H = 0.3), the
    // coarser ones 16 % at the largest (H = 0.6): either changes the exponent by 0.04.
    const auto exponent = over_draws(motion, square_grid(512, 1.0), 12, [](const HeightField& field) {
      return std::vector{0.5 * std::log(structure_function(field, 32) / structure_function(field, 8)) / std::log(4.0)};
    });
    EXPECT_NEAR(exponent[0].mean, hurst, 0.05 + 4.0 * exponent[0].error);
    EXPECT_LT(exponent[0].error, 0.01);
  }
}

TEST(Turbulence, HasItsClosedFormMeanAndSlopes) {
  const Turbulence turbulence{.scale = 128.0_um, .height = 10.0_um, .octaves = 3};
  const Pattern pattern = turbulence;
  double weights = 0.0;
  for (const Octave& octave : octave_sum(turbulence).octaves) weights += octave.weight;
  const auto drawn = over_draws(pattern, square_grid(1024, 1.0), 12, [](const HeightField& field) {
    return std::vector{mean_height(field), slope_covariance(field).xx};
  });
  expect_drawn(drawn[0], 10.0 * weights * mean_noise_magnitude, 0.003, "mean");
  // In the creases, whose facets see both sides, a little more is lost than the 0.3 % of noise: they are a share of
  // about 2·(crossings a cell)·(1/32) of the finest octave's facets, with half of the square lost at most.
  const SlopeCovariance expected = closed_form_slope_covariance(pattern).value();
  expect_drawn(drawn[1], expected.xx, 0.03, "xx");
}

TEST(Turbulence, HasRoundHillsAndSharpValleys) {
  // About the mean the valleys are near and the hills are far: a positive skewness, where noise has none.
  const auto skewness = [](const HeightField& field) {
    const double mean = mean_height(field), deviation = std::sqrt(mean_square_about(field, mean));
    double cubes = 0.0;
    for (const float z : field.heights_um()) cubes += std::pow((z - mean) / deviation, 3);
    return cubes / static_cast<double>(field.heights_um().size());
  };
  EXPECT_GT(skewness(synthesize(Turbulence{.scale = 40.0_um}, square_grid(512, 2.0))), 0.3);
  EXPECT_NEAR(skewness(synthesize(Noise{.scale = 40.0_um}, square_grid(512, 2.0))), 0.0, 0.15);
}

}  // namespace
}  // namespace mezzotint
