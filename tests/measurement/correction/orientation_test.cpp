#include "measurement/correction/orientation.h"

#include <numbers>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "tests/measurement/relief.h"

namespace mezzotint {
namespace {

using test::field_of;
using test::micrometre_grid;

const HeightField three_by_two(micrometre_grid(3, 2), Continuation::Mirrored, {0, 1, 2, 3, 4, 5});

std::vector<float> heights(const HeightField& field) { return {field.heights_um().begin(), field.heights_um().end()}; }

TEST(Orientation, AQuarterTurnIsCounterClockwise) {
  // The x axis becomes the y axis: what rose along x rises along y.
  const HeightField turned_once = turned_by_quarters(three_by_two, 1);
  EXPECT_EQ(turned_once.columns(), 2U);
  EXPECT_EQ(heights(turned_once), (std::vector<float>{3, 0, 4, 1, 5, 2}));
  EXPECT_EQ(heights(turned_by_quarters(three_by_two, -3)), heights(turned_once));
  EXPECT_EQ(heights(turned_by_quarters(turned_once, 3)), heights(three_by_two));
  EXPECT_EQ(heights(turned_by_quarters(three_by_two, 2)), (std::vector<float>{5, 4, 3, 2, 1, 0}));
}

TEST(Orientation, MirrorsKeepTheOtherAxis) {
  EXPECT_EQ(heights(mirrored_in_x(three_by_two)), (std::vector<float>{2, 1, 0, 5, 4, 3}));
  EXPECT_EQ(heights(mirrored_in_y(three_by_two)), (std::vector<float>{3, 4, 5, 0, 1, 2}));
  EXPECT_EQ(upside_down(three_by_two).at(2, 1), -5.0F);
}

TEST(Orientation, TurnedByAnAngleARidgeTurnsWithIt) {
  const auto wave = [](double angle) {
    return field_of(micrometre_grid(64, 64), [angle](double c, double r) {
      const double u = (c - 31.5) * std::cos(angle) + (r - 31.5) * std::sin(angle);
      return std::cos(0.3 * u);
    });
  };
  const double angle = 25.0 * std::numbers::pi / 180.0;
  const HeightField result = turned(wave(0.0), Angle::from_radians(angle)), expected = wave(angle);
  for (std::size_t row = 16; row < 48; ++row)
    for (std::size_t column = 16; column < 48; ++column)
      EXPECT_NEAR(result.at(column, row), expected.at(column, row), 2e-3);  // cubic convolution: k³/24 = 1e-3
  EXPECT_TRUE(std::isnan(result.at(0, 0)));
}

TEST(Resampled, KeepsAParabolaAndItsFirstSample) {
  const Grid grid{21, 11, Length::from_um(1.0), Length::from_um(2.0)};
  const HeightField field = field_of(grid, [](double c, double r) { return 0.01 * c * c - 0.5 * r; });
  const HeightField fine = resampled(field, Length::from_um(0.4), Length::from_um(1.0));
  EXPECT_EQ(fine.columns(), 51U);
  EXPECT_EQ(fine.rows(), 21U);
  for (std::size_t row = 0; row < 21; ++row)
    for (std::size_t column = 0; column < 51; ++column) {
      const double x = 0.4 * static_cast<double>(column), y = 0.5 * static_cast<double>(row);
      EXPECT_NEAR(fine.at(column, row), 0.01 * x * x - 0.5 * y, 1e-6);
    }
}

TEST(Resampled, DoesNotTurnWhatIsTooFineIntoSomethingCoarse) {
  // A wave of 2.2 samples, which every third sample alone would take for one of 8.25.
  const HeightField field =
      field_of(micrometre_grid(90, 90), [](double c, double) { return std::sin(2.0 * std::numbers::pi * c / 2.2); });
  const HeightField coarse = resampled(field, Length::from_um(3.0), Length::from_um(3.0));
  for (std::size_t column = 2; column + 2 < coarse.columns(); ++column)
    EXPECT_LT(std::abs(coarse.at(column, 10)), 0.31);  // the mean of 3 samples passes sin(3πf)/(3 sin πf) = 0.306
}

TEST(Resampled, APeriodicFieldKeepsItsPeriod) {
  const HeightField field = field_of(
      micrometre_grid(20, 20), [](double c, double) { return std::cos(2.0 * std::numbers::pi * c / 20.0); },
      Continuation::Periodic);
  const HeightField fine = resampled(field, Length::from_um(0.5), Length::from_um(1.0));
  EXPECT_EQ(fine.columns(), 40U);
  EXPECT_TRUE(fine.periodic());
  EXPECT_THROW((void)resampled(field, Length::from_um(0.7), Length::from_um(1.0)), InvalidInput);
  EXPECT_THROW((void)resampled(field, Length::from_um(0.0), Length::from_um(1.0)), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
