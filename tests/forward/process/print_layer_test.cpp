#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "forward/process/printed_relief.h"

namespace mezzotint {
namespace {

GrayImage uniform(float gray) { return {6, 6, std::vector<float>(36, gray)}; }

TEST(PrintLayer, ReproducesTheCureCurveOnAUniformWedge) {
  PrinterProfile profile;
  for (const double sigma_um : {0.0, 3.77, 11.0}) {
    profile.spread.width = Length::from_um(sigma_um);
    for (int level = 0; level <= 255; ++level) {
      const auto gray = static_cast<float>(level / 255.0);
      const double curve_um = level < 43 ? 0.0 : 17.71 + 10.24 * std::log(level / 255.0 + 0.01);
      const HeightField printed = print_layer(uniform(gray), profile, {2, Surround::Mirror});
      // Float light (1e-7, times 58 µm of slope at the threshold) and a float logarithm: the promised 1e-5 µm.
      for (const float height : printed.heights_um()) ASSERT_NEAR(height, curve_um, 1e-5) << level;
    }
  }
}

TEST(PrintLayer, FollowsTheLogarithmOverAllGrayValues) {
  PrinterProfile profile;
  profile.spread.width = Length{};
  GrayImage ramp{20000, 1, {}};
  for (int i = 0; i < 20000; ++i) ramp.values.push_back(static_cast<float>(i / 19999.0));
  const HeightField printed = print_layer(ramp, profile, {1, Surround::Mirror});
  double worst_um = 0.0;
  for (std::size_t i = 0; i < 20000; ++i) {
    const double curve_um = gray_to_height(profile.cure, ramp.values[i]).um();
    worst_um = std::max(worst_um, std::abs(printed.at(i, 0) - curve_um));
  }
  EXPECT_LT(worst_um, 1e-5);  // as promised by the header; float rounding at 17 µm is 1e-6
}

TEST(PrintLayer, NeverPrintsMoreThanTheLayer) {
  PrinterProfile profile;
  profile.cure = scale_exposure(profile.cure, 3.0);  // full gray would reach 29 µm
  const HeightField printed = print_layer(uniform(1.0F), profile, {2, Surround::Mirror});
  for (const float height : printed.heights_um()) EXPECT_EQ(height, 18.0F);
}

TEST(PrintLayer, CuresLightNotHeights) {
  // Two pixels of 0 and 1 under a wide blur: in the middle of the step the light is ½, and its height is
  // H(½) = 10.81 µm (published), not half of 17.81.
  PrinterProfile profile;
  GrayImage step{12, 1, std::vector<float>(12, 0.0F)};
  for (std::size_t i = 6; i < 12; ++i) step.values[i] = 1.0F;
  const HeightField printed = print_layer(step, profile, {15, Surround::Mirror});
  const double middle_um = 0.5 * (printed.at(89, 0) + printed.at(90, 0));
  // A 30th of a pixel either side of the edge the light is ½ ± .027: the mean of the two logarithms is
  // β·(.027/.51)²/2 = .014 µm below that of ½; the published figure is rounded to .005 µm.
  EXPECT_NEAR(middle_um, 10.81, 0.02);
}

TEST(PrintLayer, SaysWhatLiesBeyondItsEnds) {
  const PrinterProfile profile;
  EXPECT_TRUE(print_layer(uniform(0.5F), profile, {2, Surround::Repeat}).periodic());
  EXPECT_FALSE(print_layer(uniform(0.5F), profile, {2, Surround::Mirror}).periodic());
  const HeightField dark = print_layer(uniform(0.5F), profile, {2, Surround::Dark});
  EXPECT_FALSE(dark.periodic());
  EXPECT_EQ(dark.grid(), (Grid{12, 12, 3.77_um, 3.77_um}));
}

TEST(PrintLayer, ReachesTheDesignsOwnHeightsBetweenItsEdges) {
  // A design that varies slowly against pixel and blur comes out as it was asked for: at 64 pixels a wave the
  // transfer is 1 − (π/64)²/6 − 2π²·(½/64)²/1 = .9984, and curvature of the curve adds as little.
  const PrinterProfile profile;
  std::vector<float> wanted;
  for (int i = 0; i < 64; ++i) {
    wanted.push_back(static_cast<float>(9.0 + 4.0 * std::cos(2.0 * std::numbers::pi * i / 64.0)));
  }
  const HeightField design({64, 1, 7.54_um, 7.54_um}, Continuation::Periodic, wanted);
  const HeightField printed = print_layer(expose(design, profile).image, profile, {1, Surround::Repeat});
  for (std::size_t i = 0; i < 64; ++i) {
    // .0016 · 4 µm for the wave itself, and the blur's ½·(σ² + p²/12)·(h′)²/β = .5·17.9·.052²/10.24 = .0024 µm.
    EXPECT_NEAR(printed.at(i, 0), wanted[i], 0.0064 + 0.0024 + 0.001);
  }
}

}  // namespace
}  // namespace mezzotint
