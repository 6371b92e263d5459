#include "forward/pattern/pattern.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "forward/base/error.h"

namespace mezzotint {
namespace {

Grid square_grid(std::size_t side, double pitch_um) {
  return {side, side, Length::from_um(pitch_um), Length::from_um(pitch_um)};
}

void expect_covariance(const SlopeCovariance& measured, const SlopeCovariance& expected, double relative) {
  const double scale = expected.xx + expected.yy;
  EXPECT_NEAR(measured.xx, expected.xx, relative * scale);
  EXPECT_NEAR(measured.yy, expected.yy, relative * scale);
  EXPECT_NEAR(measured.xy, expected.xy, relative * scale);
}

TEST(Pattern, RidgesHaveTheirClosedFormSlopes) {
  const Pattern ridges = Ridges{.wavelength = 80.0_um, .direction = 30.0_deg, .height = 10.0_um, .skew = 0.3};
  // 128 samples a period: facets that hold an edge are 2 % of all, and their slopes are means of both sides.
  expect_covariance(slope_covariance(synthesize(ridges, square_grid(1200, 0.625))),
                    closed_form_slope_covariance(ridges).value(), 0.025);
}

TEST(Pattern, SinusoidHasItsClosedFormSlopesAndHeights) {
  const Pattern sinusoid =
      Sinusoid{.wavelength_u = 60.0_um, .wavelength_v = 90.0_um, .direction = {}, .height = 18.0_um};
  // A whole number of periods (6 × 4) and 120 samples in each: differences lose (2π/120)²/12 = 0.02 %.
  const HeightField field = synthesize(sinusoid, square_grid(721, 0.5));
  expect_covariance(slope_covariance(field), closed_form_slope_covariance(sinusoid).value(), 5e-3);
  EXPECT_NEAR(height_range(field).lowest.um(), 0.0, 0.01);
  EXPECT_NEAR(height_range(field).highest.um(), 18.0, 0.01);
}

TEST(Pattern, StretchedNoiseIsSteepAlongItsDirection) {
  const Pattern noise = Noise{.scale = 50.0_um, .stretch = 2.5, .direction = 30.0_deg, .height = 16.0_um, .seed = 4};
  const HeightField field = synthesize(noise, square_grid(3000, 1.5));
  const SlopeAxes axes = principal_axes(slope_covariance(field));
  const SlopeAxes expected = principal_axes(closed_form_slope_covariance(noise).value());
  // 90 × 36 cells of about one independent slope each: standard error √(2/3240)/2 = 1.2 % of an RMS slope,
  // √(1/3240)·σxσy/(σx²−σy²) = 0.5° of the axis. Coarse facets mix the slopes of neighbouring points, so the
  // pitch is 1/33 of a cell.
  EXPECT_NEAR(axes.rms_major, expected.rms_major, 0.036 * expected.rms_major);
  EXPECT_NEAR(axes.rms_minor, expected.rms_minor, 0.036 * expected.rms_minor);
  EXPECT_LT(axis_difference(axes.rotation, 30.0_deg).degrees(), 1.5);
}

TEST(Pattern, StaysBetweenZeroAndItsHeight) {
  for (const Pattern& pattern :
       {Pattern{Noise{.height = 12.0_um, .seed = 2}}, Pattern{Turbulence{.height = 12.0_um}},
        Pattern{FractionalBrownianMotion{.height = 12.0_um}}, Pattern{LineIntegralConvolution{.height = 12.0_um}}}) {
    const HeightField field = synthesize(pattern, square_grid(400, 8.0));
    EXPECT_GE(height_range(field).lowest.um(), 0.0) << kind_name(pattern);
    EXPECT_LE(height_range(field).highest.um(), 12.0) << kind_name(pattern);
    // It reaches most of what it may.
    EXPECT_GT(height_range(field).highest.um() - height_range(field).lowest.um(), 9.0) << kind_name(pattern);
  }
}

TEST(Pattern, AnotherInstanceIsAnotherSurfaceOfTheSameTexture) {
  const Grid grid = square_grid(64, 7.54);
  for (const Pattern& pattern : {Pattern{Noise{}}, Pattern{FractionalBrownianMotion{}}, Pattern{Turbulence{}},
                                 Pattern{LineIntegralConvolution{}}, Pattern{Sinusoid{}}, Pattern{Ridges{}}}) {
    const PatternInstance one = draw_instance(pattern, 1), two = draw_instance(pattern, 2);
    const HeightField first = synthesize(one.pattern, grid, one.origin);
    const HeightField second = synthesize(two.pattern, grid, two.origin);
    EXPECT_FALSE(std::ranges::equal(first.heights_um(), second.heights_um())) << kind_name(pattern);
    const auto before = closed_form_slope_covariance(pattern), after = closed_form_slope_covariance(two.pattern);
    EXPECT_EQ(before->xx, after->xx) << kind_name(pattern);
  }
}

TEST(Pattern, APhaseMovesItByThatPartOfItsPeriod) {
  const Grid grid = square_grid(32, 5.0);
  const Sinusoid sinusoid{.wavelength_u = 80.0_um, .wavelength_v = 50.0_um, .direction = 90.0_deg};
  Sinusoid moved = sinusoid;
  moved.phase_u = 0.25;
  moved.phase_v = 0.5;
  // u runs along y, and v against x.
  const HeightField by_phase = synthesize(moved, grid), by_place = synthesize(sinusoid, grid, {-25.0_um, 20.0_um});
  const Ridges ridges{.wavelength = 80.0_um, .skew = 0.3, .phase = 0.25}, still{.wavelength = 80.0_um, .skew = 0.3};
  const HeightField also = synthesize(ridges, grid), again = synthesize(still, grid, {20.0_um, 0.0_um});
  for (std::size_t i = 0; i < grid.size(); ++i) {
    EXPECT_NEAR(by_phase.heights_um()[i], by_place.heights_um()[i], 1e-5);
    EXPECT_NEAR(also.heights_um()[i], again.heights_um()[i], 1e-5);
  }
  EXPECT_THROW(require_valid(Ridges{.phase = 1.5}), InvalidInput);
}

TEST(Pattern, RefusesValuesWithoutMeaning) {
  EXPECT_THROW(require_valid(Noise{.scale = -1.0_um}), InvalidInput);
  EXPECT_THROW(require_valid(Noise{.stretch = 0.5}), InvalidInput);
  EXPECT_THROW(require_valid(Ridges{.skew = 1.0}), InvalidInput);
  EXPECT_THROW(require_valid(Sinusoid{.height = Length::from_um(NAN)}), InvalidInput);
  EXPECT_THROW(require_valid(FractionalBrownianMotion{.hurst = -0.1}), InvalidInput);
  EXPECT_THROW(require_valid(FractionalBrownianMotion{.octaves = 0}), InvalidInput);
  EXPECT_THROW(require_valid(Turbulence{.octaves = 17}), InvalidInput);
  EXPECT_THROW(require_valid(LineIntegralConvolution{.direction = Angle::from_radians(NAN)}), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
