#include "forward/pattern/line_integral_convolution.h"

#include <cmath>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "forward/base/random.h"
#include "forward/pattern/noise_raster.h"
#include "forward/pattern/pattern.h"
#include "forward/pattern/sparse_noise.h"
#include "tests/forward/pattern/draws.h"

namespace mezzotint {
namespace {

using test::expect_drawn;
using test::mean_square_about;
using test::over_draws;
using test::square_grid;

TEST(LineIntegralConvolution, OfShortLinesIsNoise) {
  // Lines shorter than an eighth of a cell are taken as that: smeared by (1/8)²·n''/24, which is 1.5 % of the noise's
  // deviation (with wavelengths of 1.3 cells), of which the part that is like the noise is brought back.
  const HeightField lines =
      synthesize(LineIntegralConvolution{.scale = 40.0_um, .length = 2.0_um, .height = 10.0_um}, square_grid(200, 2.0));
  const HeightField noise = synthesize(Noise{.scale = 40.0_um, .height = 10.0_um}, square_grid(200, 2.0));
  double squares = 0.0;
  for (std::size_t i = 0; i < lines.heights_um().size(); ++i) {
    squares += std::pow(lines.heights_um()[i] - noise.heights_um()[i], 2);
  }
  const double deviation = 10.0 * std::sqrt(noise_variance_at_z0);
  EXPECT_LT(std::sqrt(squares / static_cast<double>(lines.heights_um().size())), 0.015 * deviation);
}

TEST(LineIntegralConvolution, HasTheSlopesOfSmearedNoiseAcrossAndAlong) {
  const LineIntegralConvolution lines{.scale = 32.0_um, .length = 160.0_um, .height = 10.0_um};
  const SlopeCovariance expected = closed_form_slope_covariance(lines).value();
  const auto drawn = over_draws(lines, square_grid(512, 2.0), 8, [](const HeightField& field) {
    const SlopeCovariance slopes = slope_covariance(field);
    return std::vector{slopes.xx, slopes.yy, mean_square_about(field, 5.0)};
  });
  // 3 %: the closed form is that of a stationary noise, which this one nearly is; 1.2 % for differences over 1/16 of a
  // cell, 0.5 % for the cut.
  expect_drawn(drawn[0], expected.xx, 0.045, "across");
  expect_drawn(drawn[1], expected.yy, 0.045, "along");
  expect_drawn(drawn[2], 100.0 * noise_variance_at_z0, 0.035, "variance");
}

TEST(LineIntegralConvolution, ReadsTheNoiseFromARasterThatHoldsIt) {
  const NoiseLattice lattice(3, CellHash::Integer);
  const NoiseRaster raster(lattice, {-3.0, 4.0, 7.5, 12.0});
  const RandomStream stream(5, RandomPurpose::Test);
  double squares = 0.0;
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const auto u = stream.uniform4(i);
    const double x = -3.0 + 7.0 * u[0], y = 7.5 + 4.5 * u[1];
    const double error = raster(x, y) - sparse_noise(lattice, x, y, 0.0);
    EXPECT_NEAR(error, 0.0, 2e-3);
    squares += error * error;
  }
  EXPECT_LT(std::sqrt(squares / 2000.0), 4e-4);  // the noise's deviation is 0.15
}

TEST(LineIntegralConvolution, StaysAtItsDirection) {
  const Pattern lines =
      LineIntegralConvolution{.scale = 24.0_um, .length = 200.0_um, .direction = 30.0_deg, .height = 10.0_um};
  double off = 0.0;
  for (const std::uint64_t seed : {1, 2}) {
    const HeightField field = synthesize(draw_instance(lines, seed).pattern, square_grid(600, 1.2));
    off += (principal_axes(slope_covariance(field)).rotation.degrees() - 30.0) / 2.0;
  }
  // Twice 30 × 3.6 grains with slopes of 6.6 : 1: standard error √(1/216)/6.5 = 0.6°. The two triangles of a cell of
  // 1/20 of a grain see slopes at different places, which turns their axis by 0.3°.
  EXPECT_NEAR(off, 0.0, 1.9);
}

// Mean square slopes along and across the direction of the middle.
std::pair<double, double> about_middle(const HeightField& field, double middle_um) {
  double radial = 0.0, around = 0.0;
  const double pitch = field.grid().pitch_x.um();
  for (std::size_t row = 1; row + 1 < field.rows(); ++row) {
    for (std::size_t column = 1; column + 1 < field.columns(); ++column) {
      const double x = static_cast<double>(column) * pitch - middle_um;
      const double y = static_cast<double>(row) * pitch - middle_um, r = std::hypot(x, y);
      if (r < 150.0) continue;  // where lines bend within a grain
      const double sx = field.at(column + 1, row) - field.at(column - 1, row);
      const double sy = field.at(column, row + 1) - field.at(column, row - 1);
      radial += std::pow((sx * x + sy * y) / r, 2);
      around += std::pow((sy * x - sx * y) / r, 2);
    }
  }
  return {radial, around};
}

TEST(LineIntegralConvolution, RunsRoundASingularityOrTowardsIt) {
  LineIntegralConvolution lines{.scale = 24.0_um, .length = 200.0_um, .height = 10.0_um};
  const SlopeCovariance straight = closed_form_slope_covariance(lines).value();
  // Straight lines have 44 times the variance across; differences over 1/4 of a grain, and bends, take some of that.
  const double ratio = 0.5 * straight.xx / straight.yy;
  lines.singularities = {{{450.0_um, 450.0_um}, 1.0}};
  const auto [across_circles, along_circles] = about_middle(synthesize(lines, square_grid(300, 3.0)), 450.0);
  EXPECT_GT(across_circles, ratio * along_circles);
  lines.direction = 90.0_deg;
  const auto [along_rays, across_rays] = about_middle(synthesize(lines, square_grid(300, 3.0)), 450.0);
  EXPECT_GT(across_rays, ratio * along_rays);
  EXPECT_FALSE(closed_form_slope_covariance(lines).has_value());
}

TEST(LineIntegralConvolution, HasNoSeamWhereALineComesBackTurnedByHalfATurn) {
  // Index ½: once round the point the direction has turned by 180°, and half way round, at y = 299 left of the point,
  // is where its angle jumps; a line there is the same line.
  LineIntegralConvolution lines{.scale = 24.0_um, .length = 200.0_um, .height = 10.0_um};
  lines.singularities = {{{300.0_um, 299.0_um}, 0.5}};
  const HeightField field = synthesize(lines, square_grid(300, 2.0));
  double seam = 0.0, beside = 0.0;
  for (std::size_t column = 0; column < 100; ++column) {
    seam += std::pow(field.at(column, 150) - field.at(column, 149), 2);
    beside += std::pow(field.at(column, 170) - field.at(column, 169), 2) / 2.0 +
              std::pow(field.at(column, 130) - field.at(column, 129), 2) / 2.0;
  }
  // Of four grains each: within a factor of three by chance; a torn line would make a step of the noise's deviation,
  // hundreds of times the square of a sample's difference along the lines.
  EXPECT_LT(seam, 3.0 * beside);
}

TEST(LineIntegralConvolution, RefusesWhatFitsNoTileOrNoMemory) {
  LineIntegralConvolution lines;
  lines.singularities = {{{}, 1.0}};
  EXPECT_THROW((void)synthesize(lines, square_grid(64, 2.0), {}, Continuation::Periodic), InvalidInput);
  lines.singularities = {{{}, 0.3}};
  EXPECT_THROW((void)synthesize(lines, square_grid(64, 2.0)), InvalidInput);
  EXPECT_THROW((void)synthesize(LineIntegralConvolution{.scale = 0.1_um, .length = 1e5_um}, square_grid(64, 2.0)),
               InvalidInput);
}

}  // namespace
}  // namespace mezzotint
