#include <gtest/gtest.h>

#include "fabrication/job/job.h"
#include "forward/base/error.h"

namespace mezzotint {
namespace {

GrayImage small_relief() { return {3, 2, {0.0F, 0.2F, 0.4F, 0.6F, 0.8F, 1.0F}}; }

TEST(PatchJob, StacksABaseUnderTheReliefWithADarkMargin) {
  const PrinterProfile profile;
  const Job job = make_patch_job("patch", small_relief(), profile, {2, 4});
  EXPECT_EQ(job.columns, 11U);
  EXPECT_EQ(job.rows, 10U);
  EXPECT_EQ(job.printer, "dlp9000");
  ASSERT_EQ(job.layers.size(), 3U);
  EXPECT_EQ(job.layers[0].top.um(), 18.0);
  EXPECT_EQ(job.layers[2].top.um(), 54.0);
  for (std::size_t row = 0; row < 10; ++row) {
    for (std::size_t column = 0; column < 11; ++column) {
      const bool inside = column >= 4 && column < 7 && row >= 4 && row < 6;
      EXPECT_EQ(job.layers[1].gray[row * 11 + column], inside ? 255 : 0);
      // Gray 0.2 is level 51 of 255, and so on in steps of 51.
      const int level = inside ? static_cast<int>(51 * ((row - 4) * 3 + column - 4)) : 0;
      EXPECT_EQ(job.layers[2].gray[row * 11 + column], level);
    }
  }
}

TEST(PatchJob, RefusesWhatThePrinterCannotShow) {
  PrinterProfile profile;
  profile.pixels_x = 18;
  EXPECT_THROW((void)make_patch_job("wide", small_relief(), profile), InvalidInput);  // 3 + 2·8 = 19 pixels
  profile.pixels_x = 19;
  EXPECT_NO_THROW((void)make_patch_job("fits", small_relief(), profile));
  profile.gray_levels = 1024;
  EXPECT_THROW((void)make_patch_job("ten bits", small_relief(), profile), InvalidInput);
  EXPECT_THROW((void)make_patch_job("no pixels", GrayImage{}, PrinterProfile{}), InvalidInput);
  EXPECT_THROW((void)make_patch_job("margin", small_relief(), PrinterProfile{}, {1, ~std::size_t{0} / 2}),
               InvalidInput);
}

TEST(Job, IsRefusedWhenItMakesNoSense) {
  const Job good = make_patch_job("patch", small_relief(), PrinterProfile{});
  EXPECT_NO_THROW(require_valid(good));
  Job job = good;
  job.layers.clear();
  EXPECT_THROW(require_valid(job), InvalidInput);
  job = good;
  job.layers[1].gray.pop_back();
  EXPECT_THROW(require_valid(job), InvalidInput);
  job = good;
  job.layers[2].top = job.layers[1].top;
  EXPECT_THROW(require_valid(job), InvalidInput);
  job = good;
  job.layers[0].exposure_s = 0.0;
  EXPECT_THROW(require_valid(job), InvalidInput);
  job = good;
  job.columns = 100000;
  EXPECT_THROW(require_valid(job), InvalidInput);
  job = good;
  job.led_amplitude = 0;
  EXPECT_THROW(require_valid(job), InvalidInput);
  EXPECT_THROW((void)layer_image(good, good.layers.size()), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
