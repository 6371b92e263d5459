#include "fabrication/calibration/reachable_range.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/fabrication/calibration/cure_samples.h"

namespace mezzotint {
namespace {

CureFit slides_fit(double error_um) {
  return fit_cure(test::draw({.grays = test::every_level(0, 255, 15), .error_um = error_um}, 1));
}

// The figures of the slides' curve, in the project's notes: threshold .1674 (level 43), .226 and .040 µm a level,
// 17.81 µm.
TEST(ReachableRange, IsThatOfTheSlidesCurve) {
  const ReachableRange range = reachable_range(slides_fit(1e-4), {});
  EXPECT_NEAR(range.threshold.value, 0.1674, 1e-4);
  EXPECT_EQ(range.first_level.level, 43);
  EXPECT_NEAR(range.step_at_first.value, 0.226,
              0.004);  // between levels, where the note's is the slope at the threshold
  EXPECT_NEAR(range.step_at_last.value, 0.040, 5e-4);
  EXPECT_NEAR(range.full_height.value, 17.81, 5e-3);
  EXPECT_FALSE(range.saturation.has_value());
}

TEST(ReachableRange, SaysWhichLevelFillsAThinnerLayer) {
  PrinterProfile printer;
  printer.layer = 12.0_um;
  const ReachableRange range = reachable_range(slides_fit(1e-4), printer);
  ASSERT_TRUE(range.saturation.has_value());
  const double gray = std::exp((12.0 - 17.71) / 10.24) - 0.01;
  EXPECT_EQ(range.saturation->level, static_cast<int>(std::floor(gray * 255.0)) + 1);
  EXPECT_EQ(range.full_height.value, 12.0);
}

// Over many draws the threshold scatters as its standard error says: 60 of them tell to 9 %; three of these.
TEST(ReachableRange, TellsHowFarTheThresholdScatters) {
  double sum = 0.0, square = 0.0, said = 0.0;
  constexpr int draws = 60;
  for (std::uint64_t seed = 0; seed < draws; ++seed) {
    const CureFit fit = fit_cure(test::draw({.grays = test::every_level(0, 255, 15), .error_um = 0.1}, 500 + seed));
    const Quantity threshold = reachable_range(fit, {}).threshold;
    sum += threshold.value;
    square += threshold.value * threshold.value;
    said += *threshold.standard_error;
  }
  const double mean = sum / draws;
  EXPECT_NEAR(std::sqrt(square / draws - mean * mean) / (said / draws), 1.0, 0.3);
}

}  // namespace
}  // namespace mezzotint
