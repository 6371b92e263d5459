#include "forward/process/gray_image.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "forward/base/error.h"

namespace mezzotint {
namespace {

HeightField one_row(std::vector<float> heights_um, Length pitch = 7.54_um) {
  const Grid grid{heights_um.size(), 1, pitch, pitch};
  return HeightField(grid, Continuation::Mirrored, std::move(heights_um));
}

TEST(Expose, InvertsTheCureCurvePixelByPixel) {
  const PrinterProfile profile;
  const Exposure exposure = expose(one_row({0.5F, 4.0F, 10.81F, 17.0F}), profile);
  EXPECT_EQ(exposure.saturated, 0U);
  // e^((10.81 − 17.71)/10.24) − .01, by hand: a height of 10.81 µm is half gray. Float rounds at 3e-8.
  EXPECT_NEAR(exposure.image.at(2, 0), std::exp(-6.90 / 10.24) - 0.01, 1e-6);
  EXPECT_NEAR(exposure.image.at(2, 0), 0.5, 5e-4);  // H(½) = 10.81 is rounded to .005 µm
}

TEST(Expose, SaysHowManyPixelsAskedForTooMuch) {
  const PrinterProfile profile;
  const Exposure exposure = expose(one_row({17.8F, 17.9F, 18.0F, 0.0F, -3.0F}), profile);
  EXPECT_EQ(exposure.saturated, 2U);
  EXPECT_EQ(exposure.image.at(1, 0), 1.0F);
  EXPECT_EQ(exposure.image.at(2, 0), 1.0F);
  EXPECT_EQ(exposure.image.at(3, 0), 0.0F);
  EXPECT_EQ(exposure.image.at(4, 0), 0.0F);
}

TEST(Expose, CountsWhatALayerThinnerThanFullGrayCannotHold) {
  PrinterProfile profile;
  profile.layer = 10.0_um;
  const Exposure exposure = expose(one_row({9.9F, 11.0F}), profile);
  EXPECT_EQ(exposure.saturated, 1U);
  EXPECT_NEAR(exposure.image.at(1, 0), height_to_gray(profile.cure, 10.0_um), 1e-7);  // float
}

TEST(Expose, DoesNotCountFullGrayItself) {
  const PrinterProfile profile;
  const auto full = static_cast<float>(reachable_height(profile).um());
  EXPECT_EQ(expose(one_row({full, std::nextafter(full, 20.0F)}), profile).saturated, 0U);
}

TEST(Expose, RefusesAnotherPitchAndMissingSamples) {
  const PrinterProfile profile;
  EXPECT_THROW((void)expose(one_row({1.0F}, 7.5_um), profile), InvalidInput);
  EXPECT_THROW((void)expose(one_row({1.0F, std::numeric_limits<float>::quiet_NaN()}), profile), InvalidInput);
}

TEST(Quantize, RoundsToTheNearestLevel) {
  const PrinterProfile profile;
  const GrayImage image{5, 1, {0.0F, 0.49F / 255.0F, 0.51F / 255.0F, 100.4F / 255.0F, 1.0F}};
  const GrayImage rounded = quantize(image, profile);
  const std::vector<int> expected = {0, 0, 1, 100, 255};
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(rounded.values[i], static_cast<float>(expected[i] / 255.0));
  }
}

TEST(Quantize, KeepsHeightsWithinHalfAStep) {
  const PrinterProfile profile;
  std::vector<float> wanted;
  for (int i = 0; i < 500; ++i) wanted.push_back(0.3F + 0.035F * static_cast<float>(i));
  const GrayImage rounded = quantize(expose(one_row(wanted), profile).image, profile);
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const double height_um = gray_to_height(profile.cure, rounded.values[i]).um();
    // The slides' largest step is .226 µm (at the threshold): half of it, plus float rounding.
    EXPECT_NEAR(height_um, wanted[i], 0.113 + 1e-5);
  }
}

TEST(GrayImage, IsRefusedWhenItMakesNoSense) {
  const PrinterProfile profile;
  EXPECT_THROW(require_valid(GrayImage{}), InvalidInput);
  EXPECT_THROW(require_valid(GrayImage{2, 2, {0.0F, 0.0F, 0.0F}}), InvalidInput);
  EXPECT_THROW(require_valid(GrayImage{2, 1, {0.0F, 1.5F}}), InvalidInput);
  EXPECT_THROW(require_valid(GrayImage{2, 1, {0.0F, -0.1F}}), InvalidInput);
  EXPECT_THROW(require_valid(GrayImage{2, 1, {0.0F, std::numeric_limits<float>::quiet_NaN()}}), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
