#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "measurement/correction/outliers.h"
#include "measurement/correction/plane.h"

namespace mezzotint {
namespace {

constexpr float missing = std::numeric_limits<float>::quiet_NaN();

template <class Height>
HeightField field_of(const Grid& grid, const Height& height_um, Continuation continuation = Continuation::Mirrored,
                     Length datum = Length{}) {
  std::vector<float> heights_um;
  for (std::size_t row = 0; row < grid.rows; ++row) {
    for (std::size_t column = 0; column < grid.columns; ++column) {
      heights_um.push_back(static_cast<float>(height_um(column, row)));
    }
  }
  return HeightField(grid, continuation, std::move(heights_um), datum);
}

// Powers of two throughout, so that the plane's heights are exact floats.
const Grid grid{33, 17, Length::from_um(0.5), Length::from_um(2.0)};
double plane_um(std::size_t column, std::size_t row) {
  return 3.0 + 0.25 * (0.5 * static_cast<double>(column) - 8.0) - 0.125 * (2.0 * static_cast<double>(row) - 16.0);
}

TEST(Plane, IsFoundExactlyAboutTheMiddleOfTheField) {
  const Plane plane = fit_plane(field_of(grid, plane_um));
  // Sums of exact numbers: a few roundings of doubles.
  EXPECT_NEAR(plane.offset.um(), 3.0, 1e-14);
  EXPECT_NEAR(plane.slope_x, 0.25, 1e-14);
  EXPECT_NEAR(plane.slope_y, -0.125, 1e-14);
}

TEST(Plane, IsFoundExactlyWhereHalfOfTheSamplesAreMissing) {
  const auto field = field_of(grid, [](std::size_t column, std::size_t row) {
    return column > row + 9 || column % 3 == 0 ? missing : plane_um(column, row);
  });
  const Plane plane = fit_plane(field);
  // The sums about an oblique middle cancel less well than the whole field's.
  EXPECT_NEAR(plane.offset.um(), 3.0, 1e-13);
  EXPECT_NEAR(plane.slope_x, 0.25, 1e-13);
  EXPECT_NEAR(plane.slope_y, -0.125, 1e-13);
}

// Three corners of a square and a fourth that is 4 off: by hand, the residual is ±1 at each corner.
TEST(Plane, IsTheOneOfLeastSquares) {
  const Grid square{2, 2, Length::from_um(1.0), Length::from_um(1.0)};
  const HeightField field(square, Continuation::Mirrored, {0.0F, 0.0F, 0.0F, 4.0F});
  const Plane plane = fit_plane(field);
  EXPECT_DOUBLE_EQ(plane.offset.um(), 1.0);
  EXPECT_DOUBLE_EQ(plane.slope_x, 2.0);
  EXPECT_DOUBLE_EQ(plane.slope_y, 2.0);
  const HeightField levelled = level(field);
  EXPECT_FLOAT_EQ(levelled.at(0, 0), 1.0F);
  EXPECT_FLOAT_EQ(levelled.at(1, 0), -1.0F);
  EXPECT_FLOAT_EQ(levelled.at(0, 1), -1.0F);
  EXPECT_FLOAT_EQ(levelled.at(1, 1), 1.0F);
}

TEST(Plane, SubtractedFromItselfLeavesNothingAndMovesTheDatum) {
  const HeightField levelled = level(field_of(grid, plane_um, Continuation::Mirrored, Length::from_um(76340.0)));
  // The plane is right to 1e-14 a µm, over 33 µm.
  for (const float z : levelled.heights_um()) EXPECT_NEAR(z, 0.0, 1e-12);
  EXPECT_NEAR(levelled.datum().um(), 76343.0, 1e-10);
}

TEST(Plane, KeepsMissingSamplesMissing) {
  auto field = field_of(grid, plane_um);
  field.at(4, 5) = missing;
  const HeightField levelled = level(field);
  EXPECT_EQ(levelled.missing_count(), 1U);
  EXPECT_TRUE(std::isnan(levelled.at(4, 5)));
}

TEST(Plane, ATiltHasNoPeriod) {
  const auto field = field_of(grid, plane_um, Continuation::Periodic);
  EXPECT_FALSE(level(field).periodic());
  EXPECT_TRUE(subtract_plane(field, {Length::from_um(1.0), 0.0, 0.0}).periodic());
}

TEST(Plane, NeedsThreeSamplesThatSpanOne) {
  const auto on_a_diagonal =
      field_of(grid, [](std::size_t column, std::size_t row) { return column == row ? 1.0F : missing; });
  EXPECT_THROW(static_cast<void>(fit_plane(on_a_diagonal)), InvalidInput);
  const auto two =
      field_of(grid, [](std::size_t column, std::size_t row) { return column + row == 1 ? 1.0F : missing; });
  EXPECT_THROW(static_cast<void>(fit_plane(two)), InvalidInput);
  const Grid line{9, 1, Length::from_um(1.0), Length::from_um(1.0)};
  EXPECT_THROW(static_cast<void>(fit_plane(HeightField(line, Continuation::Mirrored))), InvalidInput);
}

TEST(Outliers, AreFoundAboutThePlaneNotAboutTheMean) {
  // ±0.01 µm about a plane that spans 8 µm, and one spike of 1 µm that stays within the heights of the plane.
  auto field = field_of(grid, [](std::size_t column, std::size_t row) {
    return plane_um(column, row) + ((column + row) % 2 == 0 ? 0.01 : -0.01);
  });
  field.at(20, 9) += 1.0F;
  const OutlierResult result = mask_outliers(field, 5.0);
  EXPECT_EQ(result.removed, 1U);
  EXPECT_TRUE(std::isnan(result.field.at(20, 9)));
  EXPECT_EQ(result.field.missing_count(), 1U);
  EXPECT_EQ(result.field.at(19, 9), field.at(19, 9));
}

// Two heights ±1 in equal numbers have a standard deviation of 1; one sample of 561 at 3 makes it 1.0071.
TEST(Outliers, TheLimitIsCountedInStandardDeviations) {
  auto field = field_of(grid, [](std::size_t column, std::size_t row) { return (column + row) % 2 == 0 ? 1.0 : -1.0; });
  field.at(16, 8) = 3.0F;
  EXPECT_EQ(mask_outliers(field, 2.9).removed, 1U);
  EXPECT_EQ(mask_outliers(field, 3.1).removed, 0U);
}

TEST(Outliers, RefuseALimitThatMakesNoSense) {
  const auto field = field_of(grid, plane_um);
  for (const double k : {0.0, 0.99, -3.0, 100.1, std::nan("")}) {
    EXPECT_THROW(static_cast<void>(mask_outliers(field, k)), InvalidInput) << k;
  }
}

}  // namespace
}  // namespace mezzotint
