#include "forward/surface/resample.h"

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "forward/base/error.h"

namespace mezzotint {
namespace {

constexpr float missing = std::numeric_limits<float>::quiet_NaN();

HeightField sampled(const Grid& grid, Continuation continuation, const std::function<double(double, double)>& z) {
  HeightField field(grid, continuation);
  for (std::size_t r = 0; r < grid.rows; ++r) {
    for (std::size_t c = 0; c < grid.columns; ++c) {
      field.at(c, r) =
          static_cast<float>(z(static_cast<double>(c) * grid.pitch_x.um(), static_cast<double>(r) * grid.pitch_y.um()));
    }
  }
  return field;
}

Grid grid_of(std::size_t columns, std::size_t rows, double pitch_x_um, double pitch_y_um) {
  return {columns, rows, Length::from_um(pitch_x_um), Length::from_um(pitch_y_um)};
}

double parabola(double x, double y) { return 3.0 + 0.2 * x - 0.1 * y + 0.03 * x * x - 0.02 * x * y + 0.01 * y * y; }

// Heights of a few µm are stored with 2^-24 relative: 4e-7 µm; slopes divide differences by the pitch.
constexpr double storage = 2e-6;

TEST(CubicConvolution, ReproducesAParabolaWithItsSlopes) {
  const HeightField field = sampled(grid_of(9, 8, 0.5, 0.8), Continuation::Mirrored, parabola);
  const FieldPoint point{1.83, 3.47};
  EXPECT_NEAR(height_um_at(field, point), parabola(1.83, 3.47), storage);
  const SurfacePoint surface = surface_at(field, point);
  EXPECT_NEAR(surface.height_um, parabola(1.83, 3.47), storage);
  EXPECT_NEAR(surface.slope_x, 0.2 + 0.06 * 1.83 - 0.02 * 3.47, 4 * storage);
  EXPECT_NEAR(surface.slope_y, -0.1 - 0.02 * 1.83 + 0.02 * 3.47, 4 * storage);
}

TEST(CubicConvolution, HasKeysWeightsHalfWay) {
  const std::array<double, 4> published = {-1.0 / 16.0, 9.0 / 16.0, 9.0 / 16.0, -1.0 / 16.0};
  for (std::size_t k = 0; k < 4; ++k) {
    HeightField field(grid_of(4, 4, 1.0, 1.0), Continuation::Mirrored);
    field.at(k, 2) = 1.0F;
    EXPECT_DOUBLE_EQ(height_um_at(field, {1.5, 2.0}), published[k]);
  }
}

TEST(CubicConvolution, ConvergesWithTheThirdPowerOfThePitch) {
  const auto wave = [](double x, double) { return std::sin(2.0 * std::numbers::pi * x / 64.0); };
  const auto error = [&](double pitch_um) {
    const auto columns = static_cast<std::size_t>(64.0 / pitch_um);
    const HeightField field = sampled(grid_of(columns, 4, pitch_um, pitch_um), Continuation::Periodic, wave);
    double worst = 0.0;
    for (double x = 0.1; x < 64.0; x += 0.37)
      worst = std::max(worst, std::abs(height_um_at(field, {x, 0.0}) - wave(x, 0)));
    return worst;
  };
  // Keys 1981: the error falls as h³ at least. The h³ term itself vanishes half way, so the order seen at finite
  // pitch scatters by a few tenths; linear interpolation would show 2.
  const double order = std::log2(error(8.0) / error(4.0));
  EXPECT_GT(order, 2.7);
  EXPECT_LT(order, 4.3);
}

TEST(CubicConvolution, ContinuesAPeriodicField) {
  const auto wave = [](double x, double y) { return std::cos(2.0 * std::numbers::pi * (x / 32.0 + y / 16.0)); };
  const HeightField field = sampled(grid_of(32, 16, 1.0, 1.0), Continuation::Periodic, wave);
  // (2π/16)³/… of the interpolation itself stays below 0.01.
  EXPECT_NEAR(height_um_at(field, {-0.5, 15.7}), wave(-0.5, 15.7), 0.01);
  // Whole periods further on: the same four weights, up to the round-off of the coordinates.
  EXPECT_NEAR(height_um_at(field, {31.3 - 64.0, 5.2 + 160.0}), height_um_at(field, {31.3, 5.2}), 1e-9);
}

TEST(CubicConvolution, IsMissingOutsideOfAPatch) {
  const HeightField field = sampled(grid_of(6, 5, 2.0, 2.0), Continuation::Mirrored, parabola);
  EXPECT_FALSE(std::isnan(height_um_at(field, {10.0, 8.0})));
  EXPECT_TRUE(std::isnan(height_um_at(field, {10.01, 8.0})));
  EXPECT_TRUE(std::isnan(height_um_at(field, {5.0, -0.01})));
  EXPECT_TRUE(std::isnan(height_um_at(field, {std::nan(""), 1.0})));
}

TEST(CubicConvolution, LosesOnlyTheCellsThatTouchAMissingSample) {
  const auto plane = [](double x, double y) { return 1.0 + 0.3 * x - 0.2 * y; };
  HeightField field = sampled(grid_of(8, 8, 1.0, 1.0), Continuation::Mirrored, plane);
  field.at(4, 4) = missing;
  EXPECT_TRUE(std::isnan(height_um_at(field, {3.5, 3.5})));
  EXPECT_TRUE(std::isnan(height_um_at(field, {4.0, 4.0})));
  // Its neighbours' cells are extrapolated along lines, which is exact for a plane, also at the rim.
  for (const FieldPoint point : {FieldPoint{2.5, 4.5}, {5.0, 4.0}, {3.0, 4.0}, {5.5, 2.3}, {0.5, 0.5}, {6.6, 6.7}}) {
    EXPECT_NEAR(height_um_at(field, point), plane(point.x_um, point.y_um), storage);
    EXPECT_NEAR(surface_at(field, point).slope_x, 0.3, 4 * storage);
    EXPECT_NEAR(surface_at(field, point).slope_y, -0.2, 4 * storage);
  }
}

TEST(AreaAverage, DampsASinusoidAsAMeanOverThatManySamplesDoes) {
  const auto wave = [](double x, double) { return std::cos(2.0 * std::numbers::pi * x / 16.0); };
  const HeightField field = sampled(grid_of(32, 4, 1.0, 1.0), Continuation::Periodic, wave);
  const HeightField mean = area_average(field, 4.0_um, 1.0_um);
  // Weights ½ 1 1 1 ½ over 4: (1 + 2 cos a + cos 2a)/4, a = 2π/16.
  const double a = 2.0 * std::numbers::pi / 16.0;
  const double gain = (1.0 + 2.0 * std::cos(a) + std::cos(2.0 * a)) / 4.0;
  for (std::size_t c = 0; c < 32; ++c) EXPECT_NEAR(mean.at(c, 1), gain * wave(static_cast<double>(c), 0), 1e-6);
}

TEST(AreaAverage, LeavesAPlaneAndMissesTheRimWhereItWantsWholeRectangles) {
  const auto plane = [](double x, double y) { return 0.3 * x - 0.2 * y; };
  const HeightField field = sampled(grid_of(10, 10, 1.0, 1.0), Continuation::Mirrored, plane);
  const HeightField mean = area_average(field, 3.0_um, 3.0_um, 1.0);
  EXPECT_EQ(mean.missing_count(), 36U);
  EXPECT_NEAR(mean.at(4, 6), plane(4, 6), storage);
  EXPECT_TRUE(std::isnan(mean.at(0, 5)));
}

TEST(AreaAverage, ChangesNothingUpToThePitch) {
  const HeightField field = sampled(grid_of(5, 4, 1.0, 1.0), Continuation::Mirrored, parabola);
  const HeightField mean = area_average(field, 1.0_um, 0.0_um);
  for (std::size_t k = 0; k < field.heights_um().size(); ++k) EXPECT_EQ(mean.heights_um()[k], field.heights_um()[k]);
}

TEST(AreaAverage, LeavesMissingSamplesOut) {
  HeightField field(grid_of(9, 1, 1.0, 1.0), Continuation::Mirrored, {1, 1, 1, missing, 4, 1, missing, missing, 1});
  const HeightField mean = area_average(field, 3.0_um, 1.0_um);
  EXPECT_FLOAT_EQ(mean.at(3, 0), 2.5F);    // of 1 and 4
  EXPECT_TRUE(std::isnan(mean.at(6, 0)));  // one of three
}

TEST(AreaAverage, RefusesWhatIsNoRectangle) {
  const HeightField field(grid_of(8, 8, 1.0, 1.0), Continuation::Mirrored);
  EXPECT_THROW((void)area_average(field, -1.0_um, 1.0_um), InvalidInput);
  EXPECT_THROW((void)area_average(field, 9.0_um, 1.0_um), InvalidInput);
  EXPECT_THROW((void)area_average(field, 2.0_um, 2.0_um, 0.0), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
