#include "inverse/design/blur_sensitivity.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "forward/pattern/pattern_parameters.h"

namespace mezzotint {
namespace {

// Waves along one axis, of 16 pixels; low, so that the cure curve is nearly straight over them.
DesignProblem low_waves() {
  DesignProblem problem;
  problem.target = beckmann_target({0.10, 0.02, 0.0_deg});
  problem.pattern = Ridges{.wavelength = 121.0_um, .height = 3.0_um};
  problem.free = {{"wavelength_um", 100.0, 140.0, 121.0}};
  problem.patch = {.pixels = 64, .subsamples = 4};
  problem.search_draws = 4;
  problem.fresh_draws = 4;
  problem.search.max_evaluations = 0;
  return problem;
}

TEST(BlurSensitivity, AtTheProfilesOwnBlurIsWhatTheDesignWasJudgedBy) {
  const DesignProblem problem = low_waves();
  const Design design = find_design(problem);
  const BlurredPrint same = blur_sensitivity(problem, design, {1.0}).at(0);
  EXPECT_EQ(same.slopes.axes.rms_major, design.on_fresh_draws.axes.rms_major);
  EXPECT_EQ(same.slopes.rms_major_error, design.on_fresh_draws.rms_major_error);
  EXPECT_EQ(same.width.um(), problem.printer.spread.width.um());
}

// A sine drawn in square pixels is a row of waves, at its own frequency and about every multiple of the pixels'; a
// pixel lets through sinc(f·p) of each and a Gaussian e^(−2π²σ²f²). Slopes weigh every wave by its frequency.
double rms_slope_up_to_a_factor(double wavelength_um, double pixel_um, double sigma_um) {
  double sum = 0.0;
  for (int order = -4; order <= 4; ++order) {
    const double f = 1.0 / wavelength_um + order / pixel_um, x = std::numbers::pi * f * pixel_um;
    sum += std::pow(f * std::sin(x) / x * std::exp(-2.0 * std::pow(std::numbers::pi * sigma_um * f, 2)), 2);
  }
  return std::sqrt(sum);
}

TEST(BlurSensitivity, OfASineIsTheGaussiansTransfer) {
  DesignProblem problem = low_waves();
  problem.pattern = Sinusoid{.wavelength_u = 60.32_um, .wavelength_v = 482.56_um, .height = 3.0_um};
  problem.free = {{"wavelength_u_um", 50.0, 70.0, 60.32}};
  const Design design = find_design(problem);
  const auto prints = blur_sensitivity(problem, design);
  ASSERT_EQ(prints.size(), 3U);
  const auto expected = [&](double factor) {
    return rms_slope_up_to_a_factor(get_parameter(design.pattern, "wavelength_u_um"), problem.printer.pixel_pitch.um(),
                                    factor * problem.printer.spread.width.um());
  };
  const auto ratio = [&](std::size_t i) { return prints[i].slopes.axes.rms_major / prints[1].slopes.axes.rms_major; };
  // The ground adds its variance, a few per cent of this one, and hardly changes the ratio.
  EXPECT_NEAR(ratio(0), expected(0.7) / expected(1.0), 0.01);
  EXPECT_NEAR(ratio(2), expected(1.3) / expected(1.0), 0.01);
  EXPECT_LT(ratio(2), 0.97);
}

TEST(BlurSensitivity, RefusesFactorsThatAreNone) {
  const DesignProblem problem = low_waves();
  const Design design = find_design(problem);
  EXPECT_THROW((void)blur_sensitivity(problem, design, {}), InvalidInput);
  EXPECT_THROW((void)blur_sensitivity(problem, design, {1.0, -0.7}), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
