#include "forward/surface/height_field.h"

#include <gtest/gtest.h>
#include <cmath>
#include <limits>

#include "forward/base/error.h"

namespace mezzotint {
namespace {

using namespace literals;

constexpr float missing = std::numeric_limits<float>::quiet_NaN();

HeightField three_by_two() {
  return HeightField({3, 2, 0.5_um, 0.25_um}, Continuation::Mirrored, {1, 2, 3, 4, 5, 6}, 100.0_um);
}

TEST(HeightField, RefusesABadGridBeforeItAllocates) {
  const std::size_t huge = std::size_t{1} << 40;
  EXPECT_THROW(HeightField({huge, huge, 1.0_um, 1.0_um}, Continuation::Periodic), InvalidInput);
  EXPECT_THROW(HeightField({std::size_t{1} << 16, (std::size_t{1} << 14) + 1, 1.0_um, 1.0_um}, Continuation::Periodic),
               InvalidInput);
  EXPECT_THROW(HeightField({0, 4, 1.0_um, 1.0_um}, Continuation::Periodic), InvalidInput);
  EXPECT_THROW(HeightField({4, 4, 0.0_um, 1.0_um}, Continuation::Periodic), InvalidInput);
  EXPECT_THROW(HeightField({4, 4, 1.0_um, -1.0_um}, Continuation::Periodic), InvalidInput);
  EXPECT_THROW(HeightField({4, 4, Length::from_um(std::nan("")), 1.0_um}, Continuation::Periodic), InvalidInput);
  EXPECT_THROW(require_valid_grid({4, 4, 1.0_um, Length::from_um(INFINITY)}), InvalidInput);
}

TEST(HeightField, RefusesHeightsThatDoNotFit) {
  const Grid grid{2, 2, 1.0_um, 1.0_um};
  EXPECT_THROW(HeightField(grid, Continuation::Periodic, {1, 2, 3}), InvalidInput);
  EXPECT_THROW(HeightField(grid, Continuation::Periodic, {1, 2, 3, INFINITY}), InvalidInput);
  EXPECT_EQ(HeightField(grid, Continuation::Periodic, {1, 2, 3, missing}).missing_count(), 1U);
}

TEST(HeightField, StoresRowAfterRow) {
  const HeightField field = three_by_two();
  EXPECT_EQ(field.at(2, 0), 3.0F);
  EXPECT_EQ(field.at(0, 1), 4.0F);
  EXPECT_EQ(field.datum().um(), 100.0);
  EXPECT_FALSE(field.periodic());
}

TEST(HeightField, RangesOverMeasuredSamplesOnly) {
  HeightField field = three_by_two();
  field.at(0, 0) = missing;
  EXPECT_EQ(height_range(field).lowest.um(), 2.0);
  EXPECT_EQ(height_range(field).highest.um(), 6.0);
  const HeightField blind({2, 1, 1.0_um, 1.0_um}, Continuation::Mirrored, {missing, missing});
  EXPECT_THROW((void)height_range(blind), InvalidInput);
}

TEST(HeightField, CropsToTheNamedSamples) {
  const HeightField part = crop(three_by_two(), 1, 0, 2, 2);
  ASSERT_EQ(part.columns(), 2U);
  EXPECT_EQ(part.at(0, 0), 2.0F);
  EXPECT_EQ(part.at(1, 1), 6.0F);
  EXPECT_EQ(part.grid().pitch_y, 0.25_um);
  EXPECT_EQ(part.datum(), 100.0_um);
  EXPECT_THROW((void)crop(three_by_two(), 1, 0, 3, 1), InvalidInput);
  EXPECT_THROW((void)crop(three_by_two(), 0, 0, 0, 1), InvalidInput);
  EXPECT_THROW((void)crop(three_by_two(), 4, 0, 1, 1), InvalidInput);
}

TEST(HeightField, IsPeriodicAfterACropOnlyWhereItIsWhole) {
  const HeightField field({2, 2, 1.0_um, 1.0_um}, Continuation::Periodic);
  EXPECT_TRUE(crop(field, 0, 0, 2, 2).periodic());
  EXPECT_FALSE(crop(field, 0, 0, 2, 1).periodic());
}

TEST(HeightField, HasARootMeanSquareAboutItsMeanWithoutWhatIsMissing) {
  HeightField field({2, 2, 1.0_um, 1.0_um}, Continuation::Mirrored);
  field.at(0, 0) = 7.0F;
  field.at(1, 0) = 3.0F;
  field.at(0, 1) = field.at(1, 1) = std::nanf("");
  EXPECT_EQ(root_mean_square_height(field).um(), 2.0);
  field.at(0, 0) = field.at(1, 0) = std::nanf("");
  EXPECT_THROW((void)root_mean_square_height(field), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
