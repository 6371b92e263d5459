#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "measurement/correction/fill.h"
#include "measurement/correction/plane.h"

namespace mezzotint {
namespace {

constexpr float missing = std::numeric_limits<float>::quiet_NaN();
constexpr double pi = std::numbers::pi;

struct Block {
  std::size_t first_column, last_column, first_row, last_row;
};

HeightField with_hole(HeightField field, const Block& hole) {
  for (std::size_t row = hole.first_row; row <= hole.last_row; ++row) {
    for (std::size_t column = hole.first_column; column <= hole.last_column; ++column) field.at(column, row) = missing;
  }
  return field;
}

template <class Height>
HeightField field_of(const Grid& grid, Continuation continuation, const Height& height_um) {
  HeightField field(grid, continuation);
  for (std::size_t row = 0; row < grid.rows; ++row) {
    for (std::size_t column = 0; column < grid.columns; ++column) {
      field.at(column, row) = static_cast<float>(height_um(static_cast<double>(column), static_cast<double>(row)));
    }
  }
  return field;
}

void expect_filled_alike(const HeightField& whole, const Block& hole, double tolerance_um) {
  const HeightField filled = fill_missing(with_hole(whole, hole));
  EXPECT_EQ(filled.missing_count(), 0U);
  for (std::size_t i = 0; i < whole.grid().size(); ++i) {
    ASSERT_NEAR(filled.heights_um()[i], whole.heights_um()[i], tolerance_um) << i;
  }
}

// The decay rate κ for which cos(k·c) cosh(κ·r), c and r counted in samples, solves the five-point Laplace equation
// on a grid of pitches dx ≠ dy exactly: (2 cos k − 2)/dx² + (2 cosh κ − 2)/dy² = 0.
double decay_rate(double k, const Grid& grid) {
  const double ratio = grid.pitch_y / grid.pitch_x;
  return std::acosh(1.0 + ratio * ratio * (1.0 - std::cos(k)));
}

const Grid oblong{24, 20, Length::from_um(0.8), Length::from_um(1.7)};

TEST(FillMissing, AHoleInAPlaneIsFilledExactly) {
  const auto plane =
      field_of(oblong, Continuation::Mirrored, [](double c, double r) { return 0.25 * c - 0.5 * r + 3.0; });
  // Exact floats on the rim; the solution is rounded to float.
  expect_filled_alike(plane, {3, 17, 4, 15}, 1e-6);
}

TEST(FillMissing, FollowsTheDiscreteHarmonicFunctionOfUnequalPitches) {
  const double k = 0.4, rate = decay_rate(k, oblong);
  const auto field = field_of(oblong, Continuation::Mirrored,
                              [&](double c, double r) { return std::cos(k * c) * std::cosh(rate * (r - 9.0)); });
  // The rim of the hole is rounded to float, and so is the solution: cosh reaches 31 there, so 2e-6 each.
  expect_filled_alike(field, {4, 19, 5, 13}, 1e-5);
  // With the pitches taken for equal the same hole is far off: the test can tell.
  const Grid square{24, 20, Length::from_um(1.0), Length::from_um(1.0)};
  HeightField wrong(square, Continuation::Mirrored,
                    std::vector<float>(field.heights_um().begin(), field.heights_um().end()));
  const HeightField filled = fill_missing(with_hole(wrong, {4, 19, 5, 13}));
  EXPECT_GT(std::abs(filled.at(12, 9) - field.at(12, 9)), 0.1);
}

TEST(FillMissing, TheEndOfAPatchHasNoSlopeAcrossIt) {
  // Mirrored half a sample beyond the last column, which is what leaving that neighbour out means.
  const double k = 0.3, rate = decay_rate(k, oblong);
  const auto field = field_of(oblong, Continuation::Mirrored, [&](double c, double r) {
    return std::cos(k * (c - 23.5)) * std::cosh(rate * (r - 9.0));
  });
  expect_filled_alike(field, {17, 23, 5, 13}, 1e-5);  // as above
}

TEST(FillMissing, APeriodicFieldIsFilledAcrossItsEnds) {
  const double k = 2.0 * pi / 24.0, rate = decay_rate(k, oblong);
  const auto field = field_of(oblong, Continuation::Periodic,
                              [&](double c, double r) { return std::sin(k * c) * std::cosh(rate * (r - 9.0)); });
  HeightField holed = with_hole(with_hole(field, {0, 2, 6, 12}), {21, 23, 6, 12});
  const HeightField filled = fill_missing(holed);
  for (std::size_t i = 0; i < field.grid().size(); ++i) {
    ASSERT_NEAR(filled.heights_um()[i], field.heights_um()[i], 1e-5);  // as above
  }
  EXPECT_TRUE(filled.periodic());
}

TEST(FillMissing, ALargeHoleIsFilledAsExactlyAsASmallOne) {
  // 70000 samples, far beyond a sparse factor: multigrid. A hole with a jagged rim and islands in it.
  const Grid grid{400, 300, Length::from_um(0.8), Length::from_um(1.1)};
  const double k = 0.02, rate = decay_rate(k, grid);
  const auto field = field_of(grid, Continuation::Mirrored,
                              [&](double c, double r) { return std::cos(k * c) * std::cosh(rate * (r - 150.0)); });
  HeightField holed = field;
  for (std::size_t row = 20; row < 280; ++row)
    for (std::size_t column = 30 + row % 7; column < 320 - row % 11; ++column)
      if (column % 41 != 0 || row % 37 != 0) holed.at(column, row) = missing;
  ASSERT_GT(holed.missing_count(), 70000U);
  const HeightField filled = fill_missing(holed);
  // Rounding of the rim to float (heights to 9) and of the result.
  for (std::size_t i = 0; i < grid.size(); ++i) ASSERT_NEAR(filled.heights_um()[i], field.heights_um()[i], 4e-6) << i;
}

TEST(FillMissing, OneSampleIsTheWeightedMeanOfItsFourNeighbours) {
  const Grid grid{3, 3, Length::from_um(1.0), Length::from_um(2.0)};
  const HeightField field(grid, Continuation::Mirrored, {0, 8, 0, 1, missing, 3, 0, 16, 0});
  // Weights 1/dx² = 1 along the row, 1/dy² = 1/4 along the column: (1 + 3 + (8 + 16)/4) / 2.5.
  EXPECT_FLOAT_EQ(fill_missing(field).at(1, 1), 4.0F);
}

TEST(FillMissing, OneMeasuredSampleFillsTheWholeField) {
  HeightField field = with_hole(HeightField(oblong, Continuation::Mirrored), {0, 23, 0, 19});
  field.at(7, 3) = 2.5F;
  const HeightField filled = fill_missing(field);
  for (const float z : filled.heights_um()) ASSERT_NEAR(z, 2.5F, 1e-5);  // condition number 1e3 × double, then float
}

TEST(FillMissing, LeavesMeasuredSamplesAndTheDatumAsTheyAre) {
  const Grid grid{4, 1, Length::from_um(1.0), Length::from_um(1.0)};
  const HeightField field(grid, Continuation::Mirrored, {1.0F, missing, missing, 4.0F}, Length::from_um(9.0));
  const HeightField filled = fill_missing(field);
  EXPECT_EQ(filled.at(0, 0), 1.0F);
  EXPECT_FLOAT_EQ(filled.at(1, 0), 2.0F);
  EXPECT_FLOAT_EQ(filled.at(2, 0), 3.0F);
  EXPECT_EQ(filled.at(3, 0), 4.0F);
  EXPECT_EQ(filled.datum().um(), 9.0);
}

TEST(FillMissing, APeriodOfOneOrTwoSamplesIsNoHindrance) {
  for (const std::size_t columns : {std::size_t{1}, std::size_t{2}}) {
    HeightField field({columns, 4, Length::from_um(1.0), Length::from_um(1.0)}, Continuation::Periodic);
    field.at(0, 0) = missing;
    EXPECT_EQ(fill_missing(field).at(0, 0), 0.0F);
  }
}

TEST(FillMissing, RefusesAFieldOfWhichNothingWasMeasured) {
  const HeightField field = with_hole(HeightField(oblong, Continuation::Mirrored), {0, 23, 0, 19});
  EXPECT_THROW(static_cast<void>(fill_missing(field)), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
