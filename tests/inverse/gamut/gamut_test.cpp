#include "inverse/gamut/gamut.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "forward/base/random.h"
#include "forward/pattern/pattern_parameters.h"
#include "forward/process/printed_relief.h"

namespace mezzotint {
namespace {

Target target(double alpha_x, double alpha_y, double rotation_deg = 0.0) {
  return beckmann_target({alpha_x, alpha_y, Angle::from_degrees(rotation_deg)});
}

// By the whole process: gray levels, ground as relief, facets of a mesh; nothing of the gamut's own estimator.
SlopeAxes printed(const Pattern& pattern, const PrinterProfile& printer, std::uint64_t seed) {
  constexpr std::size_t pixels = 192, subsamples = 4;
  const PatternInstance instance = draw_instance(pattern, seed);
  HeightField heights =
      synthesize(instance.pattern, {pixels, pixels, printer.pixel_pitch, printer.pixel_pitch}, instance.origin);
  const double lift_um = std::max(0.0, (reachable_height(printer) - height_of(pattern)).um());
  for (float& z : heights.heights_um()) z += static_cast<float>(lift_um);
  HeightField relief = print_layer(quantize(expose(heights, printer).image, printer), printer, {subsamples});
  add_ground(relief, printer, split_ground(printer, 550.0_nm).geometric, seed);
  return principal_axes(slope_covariance(relief));
}

// By hand: an octave of 2/3 µm over cells of 50 µm, RMS slope w/scale · √(0.8365/2). The one of 25 µm is 16 nm high,
// too little for green light: 4π · 16/550 < 1. With it the floor would be 0.0129.
TEST(GamutFormula, SaysTheFloorOfTheSlidesPrinter) {
  const GamutFormula formula = gamut_formula(PrinterProfile{}, 550.0_nm);
  const double slope = 2.0 / 3.0 / 50.0 * std::sqrt(0.8365 / 2.0);
  EXPECT_NEAR(formula.floor_alpha, std::numbers::sqrt2 * slope, 1e-9);
  EXPECT_NEAR(formula.largest_ratio(0.2), 0.2 / formula.floor_alpha, 1e-9);
  // Measured before the project began with the blur on heights: α up to 0.63 at a wavelength of 38 µm.
  EXPECT_NEAR(formula.largest_alpha, 0.63, 0.02);
  EXPECT_NEAR(formula.at_wavelength.um(), 38.0, 2.0);
}

// The octave of 2 µm is 12 nm high: geometry from 155 nm on downward, and most of all slopes.
TEST(GamutFormula, FloorRisesWhereTheFinestOctaveIsGeometry) {
  EXPECT_NEAR(gamut_formula(PrinterProfile{}, 100.0_nm).floor_alpha, 0.0406, 0.001);
}

TEST(Gamut, CallsWhatWasPrintedReachable) {
  const PrinterProfile printer;
  const RandomStream stream(11, RandomPurpose::GamutTarget);
  for (std::uint64_t i = 0; i < 8; ++i) {
    const auto u = stream.uniform4(i), v = stream.uniform4(i, 1);
    const std::string name = i % 2 == 0 ? "sinusoid" : "ridges+sinusoid";
    const GamutKind kind = gamut_kind(name, printer);
    std::vector<double> values;
    for (std::size_t k = 0; k < kind.free.size(); ++k) {
      const GamutParameter& free = kind.free[k];
      const double low = free.name == "height_um" ? free.high / 6.0 : free.low;
      values.push_back(low * std::pow(free.high / low, k < 4 ? u.at(k) : v.at(k - 4)));
    }
    const Angle direction = Angle::from_degrees(180.0 * v[3] - 90.0);
    const Pattern pattern = turned(pattern_of(kind, values, printer), direction);
    const Target wanted{.kind = "printed", .slopes = printed(pattern, printer, 100 + i)};
    const GamutVerdict verdict = judge(wanted, printer, name);
    EXPECT_NE(verdict.place, GamutPlace::Outside) << name << " " << i << ": " << verdict.why;
  }
}

struct Impossible {
  const char* kind;
  double alpha_x, alpha_y;
  const char* why;
};
class GamutRefusal : public testing::TestWithParam<Impossible> {};

TEST_P(GamutRefusal, SaysWhy) {
  const Impossible& asked = GetParam();
  const GamutVerdict verdict = judge(target(asked.alpha_x, asked.alpha_y), PrinterProfile{}, asked.kind);
  EXPECT_EQ(verdict.place, GamutPlace::Outside) << verdict.why;
  EXPECT_NE(verdict.why.find(asked.why), std::string::npos) << verdict.why;
  EXPECT_GT(verdict.distance, 0.05);
}

INSTANTIATE_TEST_SUITE_P(Kinds, GamutRefusal,
                         testing::Values(Impossible{"noise", 0.008, 0.007, "smoother than the printer's own ground"},
                                         Impossible{"sinusoid", 0.3, 0.006, "ratio 50 is above"},
                                         Impossible{"ridges", 0.3, 0.1, "along one axis only"},
                                         Impossible{"sinusoid", 0.9, 0.85, "steeper than pixel"},
                                         Impossible{"noise", 0.5, 0.3, "steeper than pixel"},
                                         Impossible{"sinusoid", 0.3, 0.014, "not stretched enough"}));

// A sinusoid reaches α 0.61 on both axes; that is where the nearest print must be, and it must print so.
TEST(Gamut, NamesTheNearestPrint) {
  const PrinterProfile printer;
  const GamutVerdict verdict = judge(target(0.9, 0.85, 30.0), printer, "sinusoid");
  ASSERT_EQ(verdict.place, GamutPlace::Outside);
  const AlphaPair shown = alphas_of(printed(verdict.pattern, printer, 5));
  // A mesh of a quarter of a pixel flattens a wave of 5 pixels by 0.4 %; gray levels and the ground's draw the rest.
  EXPECT_NEAR(shown.x / verdict.nearest.x, 1.0, 0.02);
  EXPECT_NEAR(shown.y / verdict.nearest.y, 1.0, 0.02);
  EXPECT_NEAR(get_parameter(verdict.pattern, "height_um"), reachable_height(printer).um(), 0.1);
}

TEST(Gamut, NamesOtherKindsThatReachIt) {
  const GamutVerdict verdict = judge(target(0.5, 0.3), PrinterProfile{}, "noise");
  ASSERT_EQ(verdict.place, GamutPlace::Outside);
  const auto& others = verdict.other_kinds;
  EXPECT_TRUE(std::find(others.begin(), others.end(), "sinusoid") != others.end());
  EXPECT_TRUE(std::find(others.begin(), others.end(), "ridges") == others.end());
}

// The direction of a target turns the pattern; more blur takes a steep target out of reach.
TEST(Gamut, FollowsDirectionAndBlur) {
  PrinterProfile printer;
  const GamutVerdict verdict = judge(target(0.5, 0.45, 40.0), printer, "sinusoid");
  ASSERT_NE(verdict.place, GamutPlace::Outside) << verdict.why;
  const SlopeAxes shown = printed(verdict.pattern, printer, 3);
  EXPECT_LT(axis_difference(shown.rotation, 40.0_deg).degrees(), 2.0);
  EXPECT_NEAR(alphas_of(shown).x, 0.5, 0.02);
  printer.spread.width = printer.pixel_pitch;
  EXPECT_EQ(judge(target(0.5, 0.45), printer, "sinusoid").place, GamutPlace::Outside);
}

TEST(Gamut, RefusesWhatMakesNoSense) {
  EXPECT_THROW((void)gamut_kind("waves", PrinterProfile{}), InvalidInput);
  EXPECT_THROW((void)gamut_kind("noise", PrinterProfile{}, {.longest = 10.0_um}), InvalidInput);
  EXPECT_THROW((void)gamut_kind("noise", PrinterProfile{}, {.least_pixels = 1.0}), InvalidInput);
  EXPECT_THROW((void)gamut_kind("fbm", PrinterProfile{}, {.longest = 100.0_um}), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
