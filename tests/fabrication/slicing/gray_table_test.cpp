#include "fabrication/slicing/gray_table.h"

#include <cmath>

#include <gtest/gtest.h>

#include "forward/base/error.h"

namespace mezzotint {
namespace {

TEST(GrayTable, RoundsCoverageToTheNearestLevel) {
  const GrayTable table = GrayTable::linear();
  for (int i = 0; i <= 100000; ++i) {
    const float coverage = static_cast<float>(i) / 100000.0F;
    ASSERT_EQ(table.level(coverage), std::lround(255.0 * double{coverage})) << coverage;
    ASSERT_FALSE(table.saturates(coverage));
  }
}

TEST(GrayTable, TakesTheLevelThatCuresNearest) {
  const PrinterProfile profile;
  const GrayTable table = GrayTable::through_cure(profile, profile.layer);
  for (int i = 0; i <= 20000; ++i) {
    const float coverage = static_cast<float>(i) / 20000.0F;
    const double wanted_um = double{coverage} * profile.layer.um();
    const double here = std::abs(gray_to_height(profile.cure, table.level(coverage) / 255.0).um() - wanted_um);
    for (int level = 0; level < 256; ++level) {
      const double there = std::abs(gray_to_height(profile.cure, level / 255.0).um() - wanted_um);
      ASSERT_LE(here, there + 1e-9) << coverage << ": " << level;
    }
    // The inverse of the cure curve, where it does not saturate, within the rounding of a level.
    const double gray = height_to_gray(profile.cure, Length::from_um(wanted_um));
    if (wanted_um > 0.2 && gray < 1.0) {
      ASSERT_NEAR(255.0 * gray, table.level(coverage), 0.52) << coverage;
    }
  }
}

TEST(GrayTable, KnowsThatAFullLayerOfTheSlidesSaturates) {
  const PrinterProfile profile;
  const GrayTable table = GrayTable::through_cure(profile, profile.layer);
  EXPECT_EQ(table.level(1.0F), 255);
  EXPECT_TRUE(table.saturates(1.0F));
  EXPECT_FALSE(table.saturates(0.98F));
  // α + β ln(1 − γ) of 18 µm: full gray reaches 17.81 µm.
  EXPECT_NEAR(table.largest_coverage(), 17.8119 / 18.0, 1e-5);
}

TEST(GrayTable, KeepsDarkDark) {
  const PrinterProfile profile;
  const GrayTable table = GrayTable::through_cure(profile, profile.layer);
  EXPECT_EQ(table.level(0.0F), 0);
  EXPECT_EQ(table.level(1e-4F), 0);
  EXPECT_EQ(table.level(0.01F), 43);  // 0.18 µm lies between 0.07 and 0.29 µm
}

TEST(GrayTable, RefusesMoreThanEightBits) {
  PrinterProfile deep;
  deep.gray_levels = 1024;
  EXPECT_THROW((void)GrayTable::through_cure(deep, deep.layer), InvalidInput);
  PrinterProfile coarse;
  coarse.gray_levels = 4;
  const GrayTable table = GrayTable::through_cure(coarse, coarse.layer);
  for (const float coverage : {0.0F, 0.3F, 0.5F, 0.8F, 1.0F}) EXPECT_EQ(table.level(coverage) % 85, 0);
}

}  // namespace
}  // namespace mezzotint
