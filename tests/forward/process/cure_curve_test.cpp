#include "forward/process/cure_curve.h"

#include <cmath>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "forward/process/printer_profile.h"

namespace mezzotint {
namespace {

TEST(CureCurve, HasTheSlidesThreshold) {
  // The slides' own figure, given to four digits.
  EXPECT_NEAR(threshold_gray(CureCurve{}), 0.1674, 5e-5);
}

TEST(CureCurve, CuresFrom43Of255On) {
  const CureCurve curve;
  EXPECT_EQ(gray_to_height(curve, 42.0 / 255.0).um(), 0.0);
  EXPECT_GT(gray_to_height(curve, 43.0 / 255.0).um(), 0.0);
  int usable = 0;
  for (int level = 0; level <= 255; ++level) usable += gray_to_height(curve, level / 255.0) > Length{} ? 1 : 0;
  EXPECT_EQ(usable, 213);
}

TEST(CureCurve, HasTheSlidesStepsAndFullGray) {
  const CureCurve curve;
  const auto step = [&](int level) {
    return gray_to_height(curve, (level + 1) / 255.0).um() - gray_to_height(curve, level / 255.0).um();
  };
  // Published to two digits: .22 µm at the threshold, .04 µm at white, 17.81 µm for full gray.
  EXPECT_NEAR(step(43), 0.22, 5e-3);
  EXPECT_NEAR(step(254), 0.04, 5e-3);
  EXPECT_NEAR(gray_to_height(curve, 1.0).um(), 17.81, 5e-3);
}

TEST(CureCurve, AsksForMoreThanFullGrayForAWholeLayer) {
  // f⁻¹(1) at τ = 18 µm, published to five digits.
  EXPECT_NEAR(height_to_gray(CureCurve{}, 18.0_um), 1.0187, 5e-5);
}

TEST(CureCurve, GoesThereAndBack) {
  const CureCurve curve;
  for (double height_um = 0.05; height_um < 25.0; height_um += 0.37) {
    const double gray = height_to_gray(curve, Length::from_um(height_um));
    // An exponential and a logarithm in double: some 1e-16 of 10 µm each.
    EXPECT_NEAR(gray_to_height(curve, gray).um(), height_um, 1e-12);
  }
  EXPECT_EQ(height_to_gray(curve, Length{}), 0.0);
  EXPECT_EQ(height_to_gray(curve, -1.0_um), 0.0);
}

TEST(CureCurve, IsFlatBelowItsThresholdAndContinuousAtIt) {
  const CureCurve curve;
  const double threshold = threshold_gray(curve);
  EXPECT_EQ(gray_to_height(curve, threshold).um(), 0.0);
  EXPECT_EQ(gray_to_height(curve, 0.0).um(), 0.0);
  // Slope there is β/(I₀ − γ) = 58 µm: 1e-9 further on it may be 6e-8 µm high.
  EXPECT_NEAR(gray_to_height(curve, threshold + 1e-9).um(), 0.0, 1e-7);
}

TEST(CureCurve, MovesAlphaByBetaLogOfTheExposure) {
  const CureCurve curve;
  const CureCurve longer = scale_exposure(curve, 2.0);
  // Jacobs: twice the dose cures D_p·ln 2 deeper, at any gray value that cured before.
  for (const double gray : {0.2, 0.5, 1.0}) {
    const double deeper = gray_to_height(longer, gray).um() - gray_to_height(curve, gray).um();
    EXPECT_NEAR(deeper, 10.24 * std::log(2.0), 1e-12);  // rounding in double
  }
  EXPECT_LT(threshold_gray(longer), threshold_gray(curve));
  EXPECT_THROW((void)scale_exposure(curve, 0.0), InvalidInput);
  EXPECT_THROW((void)scale_exposure(curve, 0.1), InvalidInput);  // full gray would not cure any more
}

TEST(CureCurve, RefusesCurvesThatCannotBe) {
  EXPECT_NO_THROW(require_valid(CureCurve{}));
  EXPECT_THROW(require_valid(CureCurve{17.71_um, 0.0_um, -0.01}), InvalidInput);
  EXPECT_THROW(require_valid(CureCurve{17.71_um, -1.0_um, -0.01}), InvalidInput);
  EXPECT_THROW(require_valid(CureCurve{17.71_um, 10.24_um, 1.0}), InvalidInput);
  EXPECT_THROW(require_valid(CureCurve{-1.0_um, 10.24_um, 0.0}), InvalidInput);    // never cures
  EXPECT_THROW(require_valid(CureCurve{17.71_um, 10.24_um, -0.5}), InvalidInput);  // cures in the dark
  EXPECT_THROW(require_valid(CureCurve{17.71_um, 10.24_um, std::nan("")}), InvalidInput);
}

TEST(PrinterProfile, ReachesFullGrayOrTheLayerWhereThatIsLess) {
  PrinterProfile profile;
  EXPECT_NEAR(reachable_height(profile).um(), 17.81, 5e-3);  // published to two digits
  profile.layer = 10.0_um;
  EXPECT_EQ(reachable_height(profile).um(), 10.0);
}

TEST(PrinterProfile, NamesTheKeyThatIsWrong) {
  const auto complaint = [](const PrinterProfile& profile) -> std::string {
    try {
      require_valid(profile);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(complaint(PrinterProfile{}), "");
  PrinterProfile profile;
  profile.gray_levels = 1;
  EXPECT_NE(complaint(profile).find("gray_levels"), std::string::npos);
  profile = {};
  profile.pixels_x = 0;
  EXPECT_NE(complaint(profile).find("pixels_x"), std::string::npos);
  profile = {};
  profile.spread.width = -1.0_um;
  EXPECT_NE(complaint(profile).find("[blur] sigma_um"), std::string::npos);
  profile = {};
  profile.layer = Length::from_um(std::nan(""));
  EXPECT_NE(complaint(profile).find("layer_um"), std::string::npos);
  profile = {};
  profile.ground[1].scale = Length{};
  EXPECT_NE(complaint(profile).find("scale_um"), std::string::npos);
  profile = {};
  profile.cure.beta = Length{};
  EXPECT_NE(complaint(profile).find("cure.beta_um"), std::string::npos);
}

}  // namespace
}  // namespace mezzotint
