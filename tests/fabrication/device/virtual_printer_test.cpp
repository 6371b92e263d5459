#include "fabrication/device/virtual_printer.h"

#include <cmath>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "forward/base/random.h"
#include "tests/test_data.h"

namespace mezzotint {
namespace {

constexpr std::size_t margin = 6;

GrayImage random_relief(std::size_t columns, std::size_t rows) {
  GrayImage image{columns, rows, {}};
  const RandomStream stream(3, RandomPurpose::Test);
  for (std::size_t i = 0; i < columns * rows; ++i) {
    image.values.push_back(static_cast<float>((stream.bits4(i)[0] % 256) / 255.0));
  }
  return image;
}

PrinterProfile without_ground() {
  PrinterProfile profile;
  profile.ground_amplitude = Length{};
  return profile;
}

VirtualPrinterOptions exact_stage() {
  VirtualPrinterOptions options;
  options.stage_error = Length{};
  return options;
}

TEST(VirtualPrinter, PrintsAPatchAsTheProcessModelDoes) {
  const PrinterProfile profile = without_ground();
  const GrayImage relief = random_relief(20, 12);
  const Job job = make_patch_job("patch", relief, profile, {3, margin});
  const HeightField print = print_virtually(job, profile, exact_stage());
  ASSERT_EQ(print.columns(), (20 + 2 * margin) * 4);
  ASSERT_EQ(print.rows(), (12 + 2 * margin) * 4);
  EXPECT_FALSE(print.periodic());
  EXPECT_NEAR(print.datum().um(), 54.0, 1e-9);  // three layers of 18 µm, summed in double
  const HeightField alone = print_layer(relief, profile, {4, Surround::Dark});
  for (std::size_t row = 0; row < alone.rows(); ++row) {
    for (std::size_t column = 0; column < alone.columns(); ++column) {
      const float height = print.at(column + 4 * margin, row + 4 * margin);
      const bool rim = column < 4 || row < 4 || column + 4 >= alone.columns() || row + 4 >= alone.rows();
      // Float rounding at 18 µm. At the rim a relief that does not cure shows the base's rounded edge.
      if (!rim || alone.at(column, row) > 0.0F) {
        ASSERT_NEAR(height, alone.at(column, row), 4e-6) << column << " " << row;
      } else {
        ASSERT_LE(height, 4e-6);
      }
    }
  }
}

TEST(VirtualPrinter, ShowsThePlatformInTheMargin) {
  const PrinterProfile profile = without_ground();
  const Job job = make_patch_job("patch", random_relief(8, 8), profile, {3, margin});
  const HeightField print = print_virtually(job, profile, exact_stage());
  EXPECT_NEAR(print.at(0, 0), -54.0, 4e-6);                  // float rounding
  EXPECT_NEAR(print.at(4 * (margin - 3), 40), -54.0, 4e-6);  // 3 pixels = 6σ off: no light
}

TEST(VirtualPrinter, CuresAWedgeByTheSlidesCurve) {
  const PrinterProfile profile = without_ground();
  GrayImage wedge{12 * 8, 12, std::vector<float>(12 * 8 * 12)};
  for (std::size_t i = 0; i < wedge.values.size(); ++i) {
    wedge.values[i] = static_cast<float>((30 + 25 * static_cast<int>(i % 96 / 12)) / 255.0);
  }
  const HeightField print =
      print_virtually(make_patch_job("wedge", wedge, profile, {1, margin}), profile, exact_stage());
  for (std::size_t step = 0; step < 8; ++step) {
    const double gray = (30.0 + 25.0 * static_cast<double>(step)) / 255.0;
    const double curve_um = gray > 0.1674 ? 17.71 + 10.24 * std::log(gray + 0.01) : 0.0;
    const float middle = print.at(4 * (margin + 12 * step + 6), 4 * (margin + 6));
    // Six pixels = 12σ from every edge; float light and logarithm (1e-5, see print_layer) and float at 18 µm.
    EXPECT_NEAR(middle, curve_um, 2e-5) << step;
  }
}

TEST(VirtualPrinter, CuresDeeperByBetaLogOfALongerExposure) {
  const PrinterProfile profile = without_ground();
  const GrayImage relief{12, 12, std::vector<float>(144, static_cast<float>(100 / 255.0))};
  Job job = make_patch_job("patch", relief, profile, {1, margin});
  const std::size_t middle = 4 * (margin + 6);
  const float before = print_virtually(job, profile, exact_stage()).at(middle, middle);
  job.layers[1].exposure_s = 4.5;
  const float after = print_virtually(job, profile, exact_stage()).at(middle, middle);
  EXPECT_NEAR(after - before, 10.24 * std::log(1.5), 2e-5);  // twice print_layer's 1e-5
  job.layers[1].exposure_s = 30.0;
  EXPECT_EQ(print_virtually(job, profile, exact_stage()).at(middle, middle), 18.0F);  // no more than the layer
}

TEST(VirtualPrinter, KeepsTheFrameThroughTheArchive) {
  // One bright pixel near the corner of the largest y, another slice orientation would move it.
  const test::TemporaryFolder folder;
  const PrinterProfile profile = without_ground();
  GrayImage relief{10, 14, std::vector<float>(140, 0.4F)};
  relief.values[12 * 10 + 1] = 1.0F;
  const Job job = make_patch_job("mark", relief, profile, {2, margin});
  write_uvj(job, folder / "mark.uvj");
  const HeightField direct = print_virtually(job, profile, exact_stage());
  const HeightField read = print_virtually(read_uvj(folder / "mark.uvj"), profile, exact_stage());
  EXPECT_TRUE(std::equal(direct.heights_um().begin(), direct.heights_um().end(), read.heights_um().begin()));
  const auto highest = std::max_element(read.heights_um().begin(), read.heights_um().end());
  const auto index = static_cast<std::size_t>(highest - read.heights_um().begin());
  EXPECT_EQ(index % read.columns() / 4, margin + 1);
  EXPECT_EQ(index / read.columns() / 4, margin + 12);
}

TEST(VirtualPrinter, RefusesIslandsAndVoids) {
  const PrinterProfile profile = without_ground();
  const GrayImage relief{8, 8, std::vector<float>(64, 0.5F)};
  Job job = make_patch_job("patch", relief, profile, {2, margin});
  job.layers[2].gray[0] = 255;  // in the dark margin
  EXPECT_THROW((void)print_virtually(job, profile, exact_stage()), MethodError);
  job = make_patch_job("patch", relief, profile, {2, margin});
  job.layers[1] = job.layers[2];  // half cured under the last layer: a void of 7 µm
  job.layers[1].top = 36.0_um;
  EXPECT_THROW((void)print_virtually(job, profile, exact_stage()), MethodError);
  job = make_patch_job("patch", relief, profile, {2, margin});
  job.layers[2].gray[0] = 42;  // below the threshold of 43: nothing cures there
  EXPECT_NO_THROW((void)print_virtually(job, profile, exact_stage()));
}

// A ledge of full gray at the second of four layers, two pixels out from the wall.
Job ledge_job(const PrinterProfile& profile, std::uint8_t ledge) {
  const GrayImage block{10, 10, std::vector<float>(100, 1.0F)};
  Job job = make_patch_job("ledge", block, profile, {3, margin});
  for (std::size_t row = margin; row < margin + 10; ++row) {
    for (std::size_t column = margin + 10; column < margin + 14; ++column)
      job.layers[2].gray[row * job.columns + column] = ledge;
  }
  return job;
}

TEST(VirtualPrinter, SeesAnOverhangFromAbove) {
  const PrinterProfile profile = without_ground();
  const HeightField print = print_virtually(ledge_job(profile, 255), profile, exact_stage());
  // On the ledge, 2 pixels = 4σ from its sides: the top of the third layer, filled, is the relief's lower face.
  EXPECT_NEAR(print.at(4 * (margin + 12), 4 * (margin + 5)), 0.0, 1e-4);
  EXPECT_NEAR(print.at(4 * (margin + 5), 4 * (margin + 5)), 17.8119, 1e-4);
  EXPECT_THROW((void)print_virtually(ledge_job(profile, 120), profile, exact_stage()), MethodError);
}

// A step of half gray, under three layers that are dark there: their stray light reaches it. Closed form of the sum.
TEST(VirtualPrinter, LetsTheStrayLightOfDarkLayersReachATerrace) {
  const PrinterProfile profile = without_ground();
  Job job = make_patch_job("terrace", {24, 12, std::vector<float>(24 * 12, 1.0F)}, profile, {5, margin});
  for (std::size_t layer = 2; layer < 6; ++layer) {
    for (std::size_t row = 0; row < job.rows; ++row) {
      for (std::size_t column = margin + 12; column < job.columns; ++column) {
        std::uint8_t& gray = job.layers[layer].gray[row * job.columns + column];
        gray = layer == 2 && gray == 255 ? 100 : 0;
      }
    }
  }
  const HeightField print = print_virtually(job, profile, exact_stage());
  const double q = std::exp(-18.0 / 10.24), own = 100.0 / 255.0 + 0.01, stray = 0.01 * (q + q * q + q * q * q);
  const double height_um = 36.0 - 90.0 + 17.71 + 10.24 * std::log(own + stray);
  EXPECT_NEAR(print.at(4 * (margin + 18), 4 * (margin + 6)), height_um, 2e-5);
  EXPECT_GT(10.24 * std::log(1.0 + stray / own), 0.05);  // which is no rounding
}

TEST(VirtualPrinter, DrawsItsPlatformStepsFromTheirDistribution) {
  const PrinterProfile profile = without_ground();
  const GrayImage relief{4, 4, std::vector<float>(16, 0.5F)};
  const Job job = make_patch_job("tower", relief, profile, {9, 1});
  VirtualPrinterOptions options;
  options.subsamples = 1;
  double sum = 0.0, square = 0.0;
  constexpr int prints = 400;
  for (int i = 0; i < prints; ++i) {
    options.seed = static_cast<std::uint64_t>(i);
    const double error_um = print_virtually(job, profile, options).datum().um() - 162.0;
    sum += error_um;
    square += error_um * error_um;
  }
  // Nine steps of .3 µm: .9 µm. Mean known to .9/√400 = .045 (four of these), deviation to 3.5 % (four).
  EXPECT_NEAR(sum / prints, 0.0, 0.18);
  EXPECT_NEAR(std::sqrt(square / prints) / 0.9, 1.0, 0.14);
}

TEST(VirtualPrinter, CutsTheReliefAtTheGapThatTheStageLeft) {
  const PrinterProfile profile = without_ground();
  const GrayImage relief{12, 12, std::vector<float>(144, 1.0F)};
  const Job job = make_patch_job("full", relief, profile, {1, margin});
  VirtualPrinterOptions options;
  options.stage_error = 1.0_um;
  const std::size_t middle = 4 * (margin + 6);
  int cut = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    options.seed = seed;
    const double height_um = print_virtually(job, profile, options).at(middle, middle);
    EXPECT_LE(height_um, 17.812 + 1e-3);  // full gray: 17.8119 µm
    cut += height_um < 17.81 ? 1 : 0;
  }
  // A gap below 17.81 has the chance Φ(−.19) = .42: 17 of 40 expected, ±3.1 each; four of these.
  EXPECT_NEAR(cut, 17, 12.5);
}

TEST(VirtualPrinter, AddsTheGeometricGroundWhereSomethingCured) {
  PrinterProfile profile;
  const Job job = make_patch_job("patch", random_relief(16, 16), profile, {2, margin});
  const HeightField rough = print_virtually(job, profile, exact_stage());
  const HeightField smooth = print_virtually(job, without_ground(), exact_stage());
  HeightField ground(rough.grid(), Continuation::Mirrored);
  // At 550 nm only the 50 µm octave is geometry (4πσ/λ = 2.25; .375 and .282 for the others).
  add_ground(ground, profile, {profile.ground[0]}, 1);
  for (std::size_t row = 0; row < rough.rows(); ++row) {
    for (std::size_t column = 0; column < rough.columns(); ++column) {
      const double added = rough.at(column, row) - smooth.at(column, row);
      const bool platform = smooth.at(column, row) < -35.999F;
      // Differences of floats at up to 36 µm.
      EXPECT_NEAR(added, platform ? 0.0 : ground.at(column, row), 1e-5);
    }
  }
}

TEST(VirtualPrinter, IsAnotherPrintWithAnotherSeedAndTheSameWithTheSame) {
  const PrinterProfile profile;
  const Job job = make_patch_job("patch", random_relief(8, 8), profile, {2, margin});
  VirtualPrinterOptions options;
  const HeightField a = print_virtually(job, profile, options), b = print_virtually(job, profile, options);
  EXPECT_TRUE(std::equal(a.heights_um().begin(), a.heights_um().end(), b.heights_um().begin()));
  options.seed = 2;
  const HeightField c = print_virtually(job, profile, options);
  EXPECT_FALSE(std::equal(a.heights_um().begin(), a.heights_um().end(), c.heights_um().begin()));
}

TEST(VirtualPrinter, RefusesAJobOfAnotherMachine) {
  const PrinterProfile profile = without_ground();
  const Job good = make_patch_job("patch", random_relief(8, 8), profile, {2, margin});
  Job job = good;
  job.pixel_pitch = 10.0_um;
  EXPECT_THROW((void)print_virtually(job, profile, exact_stage()), InvalidInput);
  job = good;
  job.led_amplitude = 100;
  EXPECT_THROW((void)print_virtually(job, profile, exact_stage()), InvalidInput);
  PrinterProfile small = profile;
  small.pixels_y = 10;
  EXPECT_THROW((void)print_virtually(good, small, exact_stage()), InvalidInput);
  VirtualPrinterOptions options;
  options.subsamples = 0;
  EXPECT_THROW((void)print_virtually(good, profile, options), InvalidInput);
}

TEST(VirtualPrinter, ReportsEveryLayerAndMayBeStopped) {
  const PrinterProfile profile = without_ground();
  const Job job = make_patch_job("patch", random_relief(8, 8), profile, {2, margin});
  std::vector<double> seen;
  (void)print_virtually(job, profile, exact_stage(),
                        [&](const ProgressEvent& event) { seen.push_back(event.fraction); });
  ASSERT_EQ(seen.size(), 4U);
  EXPECT_EQ(seen.front(), 0.0);
  EXPECT_EQ(seen.back(), 1.0);
  const auto stop = [](const ProgressEvent&) { throw Interrupted(); };
  EXPECT_THROW((void)print_virtually(job, profile, exact_stage(), stop), Interrupted);
}

}  // namespace
}  // namespace mezzotint
