#include "experiments/run/design_answer.h"

#include <cmath>

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include "experiments/run/design_page.h"
#include "experiments/run/gamut_of_target.h"
#include "experiments/run/gray_file.h"
#include "tests/test_data.h"

namespace mezzotint {
namespace {

struct Picture {
  int bits = 0;
  std::string description;
  std::vector<std::uint16_t> pixels;
};

Picture read_back(const std::filesystem::path& path) {
  const auto input = OIIO::ImageInput::open(path.string());
  if (!input) return {};
  Picture picture{static_cast<int>(input->spec().format.size()) * 8,
                  input->spec().get_string_attribute("ImageDescription"),
                  std::vector<std::uint16_t>(input->spec().image_pixels())};
  (void)input->read_image(0, 0, 0, 1, OIIO::TypeDesc::UINT16, picture.pixels.data());
  return picture;
}

TEST(GrayFile, HasTheLargestYOnTopAndSaysSo) {
  const test::TemporaryFolder folder;
  const GrayImage gray{2, 2, {0.0F, 1.0F / 255.0F, 2.0F / 255.0F, 1.0F}};
  EXPECT_EQ(write_gray_png(gray, 256, folder / "gray.png").levels_used, 4U);
  const Picture picture = read_back(folder / "gray.png");
  EXPECT_EQ(picture.bits, 8);
  EXPECT_EQ(picture.pixels, (std::vector<std::uint16_t>{2 * 257, 65535, 0, 257}));
  EXPECT_NE(picture.description.find("largest y"), std::string::npos) << picture.description;
}

TEST(GrayFile, HasSixteenBitsWhereEightCannotHoldTheLevels) {
  const test::TemporaryFolder folder;
  const GrayImage gray{2, 1, {1.0F / 65535.0F, 40000.0F / 65535.0F}};
  EXPECT_EQ(write_gray_png(gray, 65536, folder / "gray.png").bits, 16);
  EXPECT_EQ(read_back(folder / "gray.png").pixels, (std::vector<std::uint16_t>{1, 40000}));
}

Design turned_scan(double turned_objective) {
  Design design{.pattern = Noise{}};
  design.variables = {{"scale_um", 30.0, 400.0, 90.0, true}, {"direction_deg", -90.0, 90.0, 0.0, false}};
  design.search.values = {90.0, 80.0};
  design.search.history = {{"moments", {{90.0, -10.0}, 1e-9}, 1.0},
                           {"scan", {{90.0, -85.0}, 0.04}, 0.5},
                           {"scan", {{90.0, -5.0}, turned_objective}, 0.5}};
  return design;
}

// −85° is 15° from 80°: an axis comes back after half a turn.
TEST(AxisSwap, IsToldByTheScan) {
  const AxisSwap swap = axis_swap(turned_scan(4.0));
  EXPECT_TRUE(swap.is_free && swap.was_tried);
  EXPECT_DOUBLE_EQ(swap.worse_by, 10.0);
  EXPECT_FALSE(axis_swap(turned_scan(std::nan(""))).was_tried);
  Design fixed = turned_scan(4.0);
  fixed.variables[1].name = "height_um";
  EXPECT_FALSE(axis_swap(fixed).is_free);
}

TEST(Combinations, AreSaidInWords) {
  const std::vector<Variable> variables = {
      {"height_um", 2.0, 16.0, 8.0, true}, {"scale_um", 30.0, 400.0, 90.0, true}, {"stretch", 1.0, 8.0, 2.0, true}};
  const auto words = [&](std::vector<double> change) { return together_in_words({change, 0.1, false}, variables); };
  EXPECT_EQ(words({0.7, 0.7, 0.02}), "height_um and scale_um grow together");
  EXPECT_EQ(words({-0.7, -0.7, 0.02}), "height_um and scale_um grow together");
  EXPECT_EQ(words({0.0, -0.6, 0.8}), "scale_um grows while stretch shrinks");
  EXPECT_EQ(words({0.0, 0.01, 1.0}), "stretch by itself");
}

TEST(ShortestLength, IsThatOfTheFinestPart) {
  const Pattern sum =
      PatternSum{{{Noise{.scale = 75.4_um}}, {Sinusoid{.wavelength_u = 60.0_um, .wavelength_v = 30.16_um}}}};
  EXPECT_NEAR(shortest_length_px(sum, PrinterProfile{}), 4.0, 1e-9);
}

Experiment with_pattern(const Pattern& pattern) {
  Experiment experiment;
  experiment.pattern.pattern = pattern;
  return experiment;
}

TEST(GamutOfATarget, IsThatOfTheExperimentsPattern) {
  const Target easy = beckmann_target({0.2, 0.1, 0.0_deg}), steep = beckmann_target({0.6, 0.02, 0.0_deg});
  EXPECT_FALSE(gamut_of_target(with_pattern(Noise{}), easy).is_outside());
  const TargetGamut outside = gamut_of_target(with_pattern(Noise{}), steep);
  EXPECT_TRUE(outside.is_outside());
  EXPECT_NE(verdict_in_words(outside).find("cannot be printed with noise"), std::string::npos);
  EXPECT_NE(verdict_in_words(outside).find("ridges+sinusoid"), std::string::npos) << verdict_in_words(outside);
  const Pattern both = PatternSum{{{Sinusoid{}}, {Ridges{}}}};
  EXPECT_EQ(gamut_of_target(with_pattern(both), easy).kind, "ridges+sinusoid");
  EXPECT_FALSE(gamut_of_target(with_pattern(both), steep).is_outside());
  const TargetGamut unknown = gamut_of_target(with_pattern(Turbulence{}), easy);
  EXPECT_FALSE(unknown.verdict.has_value());
  EXPECT_NE(verdict_in_words(unknown).find("no verdict exists"), std::string::npos);
}

}  // namespace
}  // namespace mezzotint
