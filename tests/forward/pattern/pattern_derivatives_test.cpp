#include "forward/pattern/pattern_derivatives.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "forward/pattern/pattern_parameters.h"
#include "forward/pattern/sparse_noise.h"
#include "tests/forward/pattern/draws.h"

namespace mezzotint {
namespace {

using test::square_grid;

const Grid grid = square_grid(48, 7.54);

std::vector<std::string> free_names(const Pattern& pattern) {
  std::vector<std::string> names;
  for (const PatternParameter& parameter : all_parameters(pattern)) {
    if (!parameter.whole) names.push_back(parameter.name);
  }
  return names;
}

HeightField with(Pattern pattern, const std::string& name, double value) {
  set_parameter(pattern, name, value);
  return synthesize(pattern, grid);
}

// The step of a parameter for differences: lengths and ratios by factors, directions in degrees.
double step_of(const Pattern& pattern, const std::string& name, double share) {
  const bool centre = last_name(name).starts_with("centre");
  return share * (name.ends_with("_deg") ? 20.0 : centre ? 30.0 : std::abs(get_parameter(pattern, name)) + 0.1);
}

// Root mean square of the difference between derivatives and central differences (Richardson's, of two steps: an error
// of the fourth order), in units of the differences' own.
double relative_error(const Pattern& pattern, const std::string& name, const std::vector<float>& toward, double share) {
  const double value = get_parameter(pattern, name), step = step_of(pattern, name, share);
  const auto at = [&](double by) { return with(pattern, name, value + by * step); };
  const HeightField a = at(1.0), b = at(-1.0), c = at(2.0), d = at(-2.0);
  double error = 0.0, size = 0.0;
  for (std::size_t i = 0; i < toward.size(); ++i) {
    const auto difference = [i](const HeightField& high, const HeightField& low) {
      return static_cast<double>(high.heights_um()[i]) - static_cast<double>(low.heights_um()[i]);
    };
    const double slope = (8.0 * difference(a, b) - difference(c, d)) / (12.0 * step);
    error += (slope - toward[i]) * (slope - toward[i]);
    size += slope * slope;
  }
  if (size == 0.0) return std::sqrt(error);
  return std::sqrt(error / size);
}

void expect_derivatives(const Pattern& pattern, double tolerance, double share = 2e-3) {
  const Pattern drawn = draw_instance(pattern, 5).pattern;
  const std::vector<std::string> names = free_names(drawn);
  const HeightDerivatives found = synthesize_with_derivatives(drawn, grid, {}, names);
  EXPECT_TRUE(std::ranges::equal(found.heights.heights_um(), synthesize(drawn, grid).heights_um())) << "other bits";
  for (std::size_t k = 0; k < names.size(); ++k) {
    EXPECT_LT(relative_error(drawn, names[k], found.toward[k], share), tolerance)
        << kind_name(pattern) << " " << names[k];
  }
}

// Where nothing is cut and nothing has an edge, single precision is all that tells them apart: heights are known to
// 1e-6 µm (noise 3e-5 µm), and a step changes them by some 0.03 µm.
TEST(PatternDerivatives, AreThoseOfDifferencesForSmoothKinds) {
  expect_derivatives(Sinusoid{.wavelength_u = 90.0_um, .wavelength_v = 60.0_um, .direction = 25.0_deg}, 5e-5);
  expect_derivatives(PatternProduct{12.0_um, {{Sinusoid{.direction = 10.0_deg}}, {Sinusoid{}}}}, 5e-5);
}

// Noise is known to 2e-6 of its unit, and cut in 0.1 % of the samples, which differences feel a step early.
TEST(PatternDerivatives, AreThoseOfDifferencesForNoises) {
  expect_derivatives(Noise{.scale = 90.0_um, .stretch = 2.5, .direction = 35.0_deg}, 5e-4);
  expect_derivatives(Noise{.scale = 5.0_um, .stretch = 1.2, .direction = 35.0_deg}, 1e-3,
                     1e-4);  // cells smaller than samples
  expect_derivatives(
      FractionalBrownianMotion{.scale = 300.0_um, .stretch = 2.0, .direction = -20.0_deg, .hurst = 0.6, .octaves = 3},
      1e-3);
}

// An edge passes over a sample within a step in as large a share of the samples as the step is long: there the
// differences are wrong, not the derivatives. The step is small, and what is left counts by its root.
TEST(PatternDerivatives, AreThoseOfOneSideOnEdges) {
  expect_derivatives(Ridges{.wavelength = 90.0_um, .direction = 25.0_deg, .skew = 0.3}, 0.1, 2e-4);
  expect_derivatives(Turbulence{.scale = 300.0_um, .stretch = 2.0, .octaves = 2}, 0.02, 2e-4);
}

TEST(PatternDerivatives, OfALineFieldAreDifferences) {
  const LineIntegralConvolution lines{.scale = 90.0_um, .length = 300.0_um, .direction = 15.0_deg};
  expect_derivatives(lines, 5e-3);
  LineIntegralConvolution circles = lines;
  circles.singularities = {{{150.0_um, -300.0_um}, 1.0}};
  expect_derivatives(TurnedPattern{10.0_deg, {20.0_um, 30.0_um}, {{circles}}}, 1e-2);
}

TEST(PatternDerivatives, FollowACompositionThroughAllItsLevels) {
  const Noise noise{.scale = 120.0_um, .stretch = 1.5, .direction = 35.0_deg, .height = 6.0_um};
  const Sinusoid sinusoid{.wavelength_u = 150.0_um, .wavelength_v = 110.0_um, .height = 4.0_um};
  const Pattern sum = PatternSum{{{noise}, {sinusoid}, {noise}}};
  expect_derivatives(sum, 5e-4);
  const Pattern turned = TurnedPattern{30.0_deg, {40.0_um, 70.0_um}, {{sum}}};
  expect_derivatives(PatternProduct{12.0_um, {{turned}, {sinusoid}}}, 1e-3);
  const Pattern mask = Sinusoid{.wavelength_u = 250.0_um, .wavelength_v = 210.0_um};
  // The cubic of a soft edge has a kink in its slope.
  expect_derivatives(MaskedPattern{.softness = 0.9, .parts = {{turned}, {sinusoid}, {mask}}}, 1e-3);
  PatternRegions regions{.pixel = 100.0_um, .columns = 2, .rows = 2, .labels = {7, 200, 200, 7}};
  regions.parts = {{sinusoid, 7}, {turned, 200}};
  const std::vector<std::string> names = {"parts[0].wavelength_u_um", "parts[1].part.parts[0].scale_um",
                                          "parts[1].part.parts[1].height_um", "parts[0].height_um", "corner_x_um"};
  const HeightDerivatives found = synthesize_with_derivatives(regions, grid, {}, names);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_LT(relative_error(regions, names[k], found.toward[k], 2e-3), 1e-3) << names[k];
  }
  EXPECT_TRUE(std::ranges::all_of(found.toward[4], [](float slope) { return slope == 0.0F; }));
}

TEST(PatternDerivatives, TellHowTheHeightOfTheWholeChanges) {
  const Pattern sum = PatternSum{{{Noise{.height = 3.0_um}}, {PatternProduct{5.0_um, {{Ridges{}}, {Noise{}}}}}}};
  const Pattern masked = MaskedPattern{.parts = {{sum}, {Noise{.height = 2.0_um}}, {Sinusoid{}}}};
  const std::vector<std::string> names = {"inside.parts[0].height_um", "inside.parts[1].height_um", "outside.height_um",
                                          "inside.parts[0].scale_um"};
  const HeightDerivatives found = synthesize_with_derivatives(masked, grid, {}, names);
  EXPECT_EQ(found.of_height, (std::vector<double>{1.0, 1.0, 0.0, 0.0}));
}

TEST(PatternDerivatives, AreRefusedTowardWhatHasNone) {
  const std::vector<std::string> whole = {"octaves"}, unknown = {"parts[0].scale_um"};
  EXPECT_THROW((void)synthesize_with_derivatives(Turbulence{}, grid, {}, whole), InvalidInput);
  EXPECT_THROW((void)synthesize_with_derivatives(Turbulence{}, grid, {}, unknown), InvalidInput);
}

TEST(SparseNoise, HasTheGradientOfItsDifferences) {
  const NoiseLattice lattice(7, CellHash::Integer);
  constexpr double step = 1e-4;
  for (int i = 0; i < 200; ++i) {
    const double x = 0.37 * i - 20.0, y = 0.71 * i, z = 0.25;
    const auto [along_x, along_y] = sparse_noise_gradient(lattice, x, y, z);
    const auto noise = [&](double dx, double dy) { return sparse_noise(lattice, x + dx, y + dy, z); };
    // Third derivatives of some 100 a cell³: (1e-4)²·100/6.
    EXPECT_NEAR(along_x, (noise(step, 0.0) - noise(-step, 0.0)) / (2.0 * step), 1e-6);
    EXPECT_NEAR(along_y, (noise(0.0, step) - noise(0.0, -step)) / (2.0 * step), 1e-6);
  }
}

}  // namespace
}  // namespace mezzotint
