#include "measurement/pattern_fit/noise_model.h"

#include <cmath>

#include <gtest/gtest.h>

#include "forward/base/random.h"
#include "forward/pattern/sparse_noise.h"
#include "measurement/pattern_fit/line_model.h"

namespace mezzotint {
namespace {

// What is finer than the samples folds back: their spectrum holds the whole variance however coarse they are.
TEST(NoiseModel, KeepsItsVarianceOnAnyGrid) {
  for (const double samples_a_cell : {9.0, 7.0, 3.0, 2.0, 1.0}) {
    const Grid grid{256, 192, Length::from_um(2.0), Length::from_um(3.0)};
    const FitView view(HeightField(grid, Continuation::Mirrored));
    const NoiseNumbers numbers{.log_height = std::log(10.0), .log_scale = std::log(3.0 * samples_a_cell)};
    const std::vector<double> density = expected_density({.octaves = 1}, numbers, view.blocks(), grid);
    double sum = 0.0;
    for (std::size_t i = 0; i < density.size(); ++i) sum += view.blocks()[i].count * density[i];
    // Of the half-plane. Nine frequencies around 0 are left out: 0.7 % of the variance where cells are fewest.
    EXPECT_NEAR(2.0 * sum / (256 * 2.0 * 192 * 3.0), 100.0 * noise_variance_at_z0, 0.01 * 100.0 * noise_variance_at_z0)
        << samples_a_cell;
  }
}

// The mean of the periodogram of white noise is its variance times the area of a sample: 24 000 frequencies.
TEST(FitView, SeesWhiteNoiseAsItsDensity) {
  const Grid grid{256, 192, Length::from_um(2.0), Length::from_um(3.0)};
  HeightField field(grid, Continuation::Mirrored);
  const RandomStream random(1, RandomPurpose::Test);
  for (std::size_t i = 0; i < grid.size(); ++i) field.heights_um()[i] = static_cast<float>(random.normal4(i)[0]);
  const FitView view(field);
  const std::vector<double> density = view.periodogram(view.seen(field));
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < density.size(); ++i) {
    sum += view.blocks()[i].count * density[i];
    count += view.blocks()[i].count;
  }
  EXPECT_NEAR(sum / count, 6.0, 6.0 * 4.0 / std::sqrt(FitView::independent_share * count));
}

TEST(LineModel, HasTheDerivativesOfItsHeight) {
  const LineNumbers at{.waves_u_per_um = 0.02,
                       .direction = 0.4,
                       .height_um = 5.0,
                       .phase_u = 0.1,
                       .waves_v_per_um = 0.03,
                       .phase_v = 0.7,
                       .skew = 0.3,
                       .offset_um = 1.0,
                       .slope_x = 0.01,
                       .slope_y = -0.02};
  for (const LineKind kind : {LineKind::Sinusoid, LineKind::Ridges}) {
    LineGradient gradient, unused;
    static_cast<void>(line_height(kind, at, 37.0, 11.0, gradient));
    for (std::size_t i = 0; i < line_numbers; ++i) {
      LineNumbers up = at, down = at;
      *members(up).at(i) += 1e-6;
      *members(down).at(i) -= 1e-6;
      const double slope =
          (line_height(kind, up, 37.0, 11.0, unused) - line_height(kind, down, 37.0, 11.0, unused)) / 2e-6;
      EXPECT_NEAR(gradient.at(i), slope, 1e-4 * std::max(1.0, std::abs(slope))) << i;  // central differences
    }
  }
}

// The same relief under other names: a crossed wave turned by 90°, ridges seen from behind.
TEST(LineModel, ReportsOneOfTheFormsThatAreTheSameRelief) {
  const LineNumbers turned{.waves_u_per_um = 0.02, .direction = 1.2, .height_um = 5.0, .waves_v_per_um = 0.05};
  const LineNumbers crossed = in_reported_form(LineKind::Sinusoid, turned);
  EXPECT_NEAR(crossed.direction, 1.2 - std::acos(0.0), 1e-12);
  EXPECT_EQ(crossed.waves_u_per_um, 0.05);
  const LineNumbers behind{.waves_u_per_um = 0.02, .direction = 2.0, .height_um = 5.0, .skew = 0.2};
  const LineNumbers ridges = in_reported_form(LineKind::Ridges, behind);
  EXPECT_NEAR(ridges.direction, 2.0 - 2.0 * std::acos(0.0), 1e-12);
  EXPECT_NEAR(ridges.skew, 0.8, 1e-12);
}

}  // namespace
}  // namespace mezzotint
