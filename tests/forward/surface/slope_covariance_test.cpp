#include "forward/surface/slope_covariance.h"

#include <gtest/gtest.h>
#include <cmath>
#include <limits>
#include <numbers>

#include "forward/base/error.h"

namespace mezzotint {
namespace {

using namespace literals;

HeightField sampled(const Grid& grid, Continuation continuation, const auto& height_um) {
  HeightField field(grid, continuation);
  for (std::size_t r = 0; r < grid.rows; ++r) {
    for (std::size_t c = 0; c < grid.columns; ++c) {
      field.at(c, r) = static_cast<float>(height_um(static_cast<double>(c), static_cast<double>(r)));
    }
  }
  return field;
}

TEST(SlopeCovariance, LeavesOutATilt) {
  const HeightField plane =
      sampled({20, 10, 0.5_um, 2.0_um}, Continuation::Mirrored, [](double c, double r) { return 0.25 * c - 0.5 * r; });
  const SlopeCovariance covariance = slope_covariance(plane);
  EXPECT_NEAR(covariance.xx, 0.0, 1e-12);  // heights are exact in binary: rounding of the sums only
  EXPECT_NEAR(covariance.yy, 0.0, 1e-12);
  EXPECT_NEAR(covariance.xy, 0.0, 1e-12);
}

TEST(SlopeCovariance, OfAWaveIsHalfTheSquareOfItsSteepestSlope) {
  // z = A sin(k·p): ⟨z_x²⟩ = A²k_x²/2 and so on; k at 30° by the ratio of the pitches.
  const double pitch_y = std::sqrt(3.0), k = 2.0 * std::numbers::pi / 200.0, amplitude_um = 6.0;
  const HeightField wave = sampled({200, 200, 1.0_um, Length::from_um(pitch_y)}, Continuation::Periodic,
                                   [&](double c, double r) { return amplitude_um * std::sin(k * (c + r)); });
  const SlopeCovariance covariance = slope_covariance(wave);
  const double xx = 0.5 * amplitude_um * amplitude_um * k * k;
  // A difference quotient over a cell instead of a derivative: sinc²(k/2) = 1 − k²/12 = 1 − 8e-5.
  EXPECT_NEAR(covariance.xx / xx, 1.0, 2e-4);
  EXPECT_NEAR(covariance.yy / (xx / 3.0), 1.0, 2e-4);
  const SlopeAxes axes = principal_axes(covariance);
  EXPECT_NEAR(axes.rotation.degrees(), 30.0, 0.01);  // as above
  EXPECT_NEAR(axes.rms_major, std::sqrt(xx * 4.0 / 3.0), 1e-4);
  // The two legs of a facet lie one phase step k apart, so that the slopes are correlated by cos k only: a minor
  // axis of √xx·k/2, to second order in k.
  EXPECT_NEAR(axes.rms_minor, 0.5 * k * std::sqrt(xx), 1e-5);
}

TEST(SlopeCovariance, CountsTheCellsThatCloseAPeriod) {
  // A saw of one tooth: slope 1 in three cells and −3 in the closing one. Mean 0, mean square 3.
  const auto saw = [](double c, double) { return c; };
  EXPECT_NEAR(slope_covariance(sampled({4, 4, 1.0_um, 1.0_um}, Continuation::Periodic, saw)).xx, 3.0, 1e-12);
  EXPECT_NEAR(slope_covariance(sampled({4, 4, 1.0_um, 1.0_um}, Continuation::Mirrored, saw)).xx, 0.0, 1e-12);
}

TEST(SlopeCovariance, LeavesOutCellsWithAMissingCorner) {
  // A spike where the instrument saw nothing must not count, nor must the hole.
  HeightField field = sampled({8, 8, 1.0_um, 1.0_um}, Continuation::Mirrored, [](double c, double) { return 2.0 * c; });
  field.at(3, 3) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NEAR(slope_covariance(field).xx, 0.0, 1e-12);
  const HeightField hole({2, 2, 1.0_um, 1.0_um}, Continuation::Mirrored, {0, 1, 2, std::nanf("")});
  EXPECT_THROW((void)slope_covariance(hole), InvalidInput);
  EXPECT_THROW((void)slope_covariance(HeightField({1, 5, 1.0_um, 1.0_um}, Continuation::Mirrored)), InvalidInput);
}

TEST(SlopeCovariance, AndItsAxesAreInverses) {
  for (const double rotation_deg : {-80.0, -45.0, 0.0, 30.0, 90.0}) {
    const SlopeAxes axes{0.4, 0.1, Angle::from_degrees(rotation_deg)};
    const SlopeAxes back = principal_axes(covariance_of(axes));
    EXPECT_NEAR(back.rms_major, 0.4, 1e-12);  // rounding
    EXPECT_NEAR(back.rms_minor, 0.1, 1e-12);
    EXPECT_NEAR(axis_difference(back.rotation, axes.rotation).degrees(), 0.0, 1e-9);
    EXPECT_GT(back.rotation.degrees(), -90.0);
    EXPECT_LE(back.rotation.degrees(), 90.0);
  }
  EXPECT_EQ(principal_axes({0.04, 0.04, 0.0}).rotation.radians(), 0.0);
}

TEST(AxisDifference, HasAPeriodOf180Degrees) {
  const auto difference = [](double a, double b) {
    return axis_difference(Angle::from_degrees(a), Angle::from_degrees(b)).degrees();
  };
  EXPECT_NEAR(difference(80.0, -80.0), 20.0, 1e-9);  // rounding
  EXPECT_NEAR(difference(10.0, 100.0), 90.0, 1e-9);
  EXPECT_NEAR(difference(370.0, 10.0), 0.0, 1e-9);
  EXPECT_NEAR(difference(0.0, 135.0), 45.0, 1e-9);
}

}  // namespace
}  // namespace mezzotint
