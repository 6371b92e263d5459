#include "fabrication/calibration/wedge_scan.h"

#include <cmath>

#include <gtest/gtest.h>

#include "fabrication/calibration/cure_fit.h"
#include "fabrication/calibration/wedge_layout.h"
#include "fabrication/device/virtual_printer.h"
#include "forward/base/error.h"
#include "forward/base/random.h"
#include "measurement/instrument/virtual_profilometer.h"

namespace mezzotint {
namespace {

std::vector<double> grays_of(const std::vector<int>& levels) {
  std::vector<double> grays;
  for (const int level : levels) grays.push_back(level / 255.0);
  return grays;
}

bool covers(const FittedNumber& number, double truth) { return number.low_95 <= truth && truth <= number.high_95; }

// A wedge on the virtual printer, with the platform around it as a scan shows it.
HeightField printed(const WedgeLayout& layout, const PrinterProfile& profile, std::uint64_t seed) {
  constexpr std::size_t margin = 4;
  VirtualPrinterOptions options;
  options.subsamples = 2;
  options.seed = seed;
  const Job job = make_patch_job("wedge", wedge_image(layout), profile, {2, margin});
  return print_virtually(job, profile, options);
}

VirtualProfilometer instrument(std::uint64_t seed) {
  VirtualProfilometer instrument;
  instrument.pitch = Length::from_um(4.0);
  instrument.tilt_x = 3e-3;
  instrument.tilt_y = -2e-3;
  instrument.offset = Length::from_mm(12.0);
  instrument.bandwidth = Length::from_um(10.0);
  instrument.noise = Length::from_nm(60.0);
  instrument.missing_share = 0.01;
  instrument.outlier_share = 0.002;
  instrument.outlier_size = Length::from_um(15.0);
  instrument.seed = seed;
  return instrument;
}

TEST(WedgeLayout, ReadsLevels) {
  EXPECT_EQ(parse_levels("255,0:60:15"), (std::vector<int>{255, 0, 15, 30, 45, 60}));
  EXPECT_EQ(parse_levels("30:0:15,7"), (std::vector<int>{30, 15, 0, 7}));
  EXPECT_EQ(parse_levels(default_wedge_levels).size(), 19U);
  for (const char* bad : {"", "a", "0:300:15", "0:10:0", "5", "1,,2", "0:10:1:2"})
    EXPECT_THROW((void)parse_levels(bad), InvalidInput) << bad;
}

TEST(WedgeLayout, LaysStripsInAFrame) {
  const GrayImage image = wedge_image({{0, 255, 51}, 3, 2, 1});
  ASSERT_EQ(image.columns, 11U);
  ASSERT_EQ(image.rows, 4U);
  EXPECT_EQ(image.at(4, 0), 0.0F);
  EXPECT_EQ(image.at(4, 1), 1.0F);
  EXPECT_EQ(image.at(6, 2), 1.0F);
  EXPECT_FLOAT_EQ(image.at(7, 2), 0.2F);
  EXPECT_EQ(image.at(10, 2), 0.0F);
}

// Ground noise, blur, stage, and an instrument with tilt, offset, noise, spikes and holes.
TEST(WedgeScan, LeadsFromAPrintedWedgeToTheCurve) {
  const PrinterProfile profile;
  const WedgeLayout layout{parse_levels(default_wedge_levels), 24, 40, 14};
  int alpha = 0, beta = 0, gamma = 0;
  constexpr int prints = 8;
  for (std::uint64_t seed = 1; seed <= prints; ++seed) {
    const HeightField scan = measure_virtually(printed(layout, profile, seed), instrument(seed));
    const WedgeScan wedge = measure_wedge(scan, {grays_of(layout.levels)});
    ASSERT_EQ(wedge.steps.size(), 19U);
    EXPECT_NEAR(wedge.step_width.um(), 24 * 7.54, 2.0);
    // 18 plateaus of 110 µm and a frame of 3.5 mm; ground of .1 µm: 2e-5.
    EXPECT_NEAR(wedge.tilt_x, 3e-3, 1e-4);
    EXPECT_NEAR(wedge.tilt_y, -2e-3, 5e-4);
    CureFitOptions options;
    options.common_error_um = wedge.base_error_um;
    const CureFit fit = fit_cure(cure_points(wedge), options);
    EXPECT_TRUE(fit.gamma_is_determined);
    EXPECT_LT(fit.gamma.standard_error, 0.02);
    alpha += covers(fit.alpha_um, 17.71) ? 1 : 0;
    beta += covers(fit.beta_um, 10.24) ? 1 : 0;
    gamma += covers(fit.gamma, -0.01) ? 1 : 0;
  }
  // Of 8 at 95 % fewer than 6 has a chance of 6e-3; errors that were too small by half would give 5 on average.
  EXPECT_GE(alpha, 6);
  EXPECT_GE(beta, 6);
  EXPECT_GE(gamma, 6);
}

// A relief of exact strips: everything that is reported can be counted.
HeightField exact_wedge(const std::vector<double>& heights_um, std::size_t width, std::size_t frame, bool turned,
                        std::size_t across = 60) {
  const std::size_t along = heights_um.size() * width + 2 * frame;
  HeightField field({turned ? across : along, turned ? along : across, 2.0_um, 2.0_um}, Continuation::Mirrored);
  for (std::size_t i = frame; i < along - frame; ++i) {
    for (std::size_t j = 10; j < across - 10; ++j) {
      const auto height = static_cast<float>(heights_um[(i - frame) / width]);
      (turned ? field.at(j, i) : field.at(i, j)) = height;
    }
  }
  return field;
}

TEST(WedgeScan, FindsExactStepsFromEitherEndAndAlongEitherAxis) {
  const std::vector<double> grays{0.0, 0.1, 0.2, 0.4, 0.6, 0.8, 1.0}, heights_um{0.0, 0.0, 2.0, 5.0, 9.0, 12.0, 13.5};
  for (const bool turned : {false, true}) {
    for (const bool reversed : {false, true}) {
      std::vector<double> laid = heights_um;
      if (reversed) std::reverse(laid.begin(), laid.end());
      WedgeScanOptions options{grays};
      options.along = turned ? WedgeAxis::Y : WedgeAxis::X;
      const WedgeScan wedge = measure_wedge(exact_wedge(laid, 60, 50, turned), options);
      EXPECT_EQ(wedge.reversed, reversed);
      EXPECT_NEAR(wedge.step_width.um(), 120.0, 0.1);
      for (std::size_t i = 0; i < grays.size(); ++i) EXPECT_NEAR(wedge.steps[i].height_um, heights_um[i], 1e-5) << i;
      EXPECT_NEAR(wedge.steps[reversed ? 6 : 0].from.um(), 100.0, 1.0);
      EXPECT_EQ(wedge.standing_out, 5U);
      EXPECT_FALSE(wedge.notes.empty());  // two steps are level with each other
    }
  }
}

TEST(WedgeScan, SaysWhenTheNumberOfStepsIsNotWhatWasTold) {
  const std::vector<double> heights_um{14.0, 0.0, 1.0, 3.0, 6.0, 10.0, 14.0};
  const HeightField scan = exact_wedge(heights_um, 60, 50, false);
  EXPECT_NO_THROW((void)measure_wedge(scan, {{1.0, 0.0, 0.2, 0.4, 0.6, 0.8, 1.0}}));
  for (const auto& grays : {std::vector<double>{1.0, 0.0, 0.3, 0.5, 0.7, 1.0},
                            std::vector<double>{1.0, 0.0, 0.2, 0.3, 0.4, 0.6, 0.8, 1.0}}) {
    try {
      (void)measure_wedge(scan, {grays});
      FAIL() << grays.size();
    } catch (const InvalidInput& error) {
      const std::string text = error.what();
      EXPECT_NE(text.find("shows 7 steps"), std::string::npos) << text;
      EXPECT_NE(text.find("not the " + std::to_string(grays.size())), std::string::npos) << text;
    }
  }
}

TEST(WedgeScan, RefusesAScanWithoutBase) {
  const std::vector<double> heights_um{2.0, 4.0, 6.0, 8.0};
  const HeightField scan = crop(exact_wedge(heights_um, 60, 50, false), 50, 10, 240, 40);
  EXPECT_THROW((void)measure_wedge(scan, {{0.2, 0.3, 0.5, 0.8}}), InvalidInput);
  const HeightField nothing({100, 50, 1.0_um, 1.0_um}, Continuation::Mirrored, std::vector<float>(5000, NAN));
  EXPECT_THROW((void)measure_wedge(nothing, {{0.2, 0.3, 0.5, 0.8}}), InvalidInput);
}

// White noise under a wedge whose every height is known: a step's error is σ/√n. Correlated over blocks of 8 × 8
// samples it is 8 times that, though single samples look the same.
TEST(WedgeScan, TellsErrorsThatAllowForCorrelation) {
  const std::vector<double> grays{0.0, 0.3, 0.6, 1.0}, heights_um{0.0, 4.0, 9.0, 13.0};
  for (const std::size_t block : {std::size_t{1}, std::size_t{8}}) {
    double chi_squared = 0.0, count = 0.0, said = 0.0;
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
      HeightField scan = exact_wedge(heights_um, 100, 100, false, 200);
      const RandomStream stream(seed, RandomPurpose::Test);
      for (std::size_t row = 0; row < scan.rows(); ++row) {
        for (std::size_t column = 0; column < scan.columns(); ++column)
          scan.at(column, row) += static_cast<float>(0.2 * stream.normal4(column / block + 10000 * (row / block))[0]);
      }
      const WedgeScan wedge = measure_wedge(scan, {grays});
      for (std::size_t i = 1; i < 4; ++i) {
        const double error = std::hypot(wedge.steps[i].standard_error_um, wedge.base_error_um);
        chi_squared += std::pow((wedge.steps[i].height_um - heights_um[i]) / error, 2.0);
        said += wedge.steps[i].standard_error_um * std::sqrt(static_cast<double>(wedge.steps[i].samples));
        count += 1.0;
      }
      EXPECT_NEAR(wedge.roughness_um, 0.2, 0.03);
    }
    // √n times the error is σ times the block's side: .2 and 1.6; the largest of several sizes, and the tilt, add
    // some.
    EXPECT_NEAR(said / count / (0.2 * static_cast<double>(block)), 1.2, 0.35) << block;
    // 36 squares about 1: ±.24, three of these; below where errors allow for too much.
    EXPECT_LT(chi_squared / count, 1.7) << block;
    EXPECT_GT(chi_squared / count, 0.3) << block;
  }
}

}  // namespace
}  // namespace mezzotint
