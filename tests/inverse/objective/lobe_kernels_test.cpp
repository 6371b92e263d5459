#include <cmath>
#include <limits>
#include <numeric>

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include "forward/base/error.h"
#include "forward/base/random.h"
#include "inverse/objective/smooth_lobe.h"
#include "tests/inverse/objective/scalar_lobe.h"

namespace mezzotint {
namespace {

struct Slopes {
  std::vector<float> x, y;
};

// Normal variates of the given RMS, and a few facets on edges, beyond the horizon and absurdly steep.
Slopes slopes_of(std::size_t points, double rms) {
  const RandomStream stream(11, RandomPurpose::Test);
  Slopes slopes;
  for (std::size_t i = 0; i < points; ++i) {
    const auto u = stream.uniform4(i);
    const double radius = rms * std::sqrt(-2.0 * std::log(1.0 - u[0])), turn = 6.283185307179586 * u[1];
    slopes.x.push_back(static_cast<float>(radius * std::cos(turn)));
    slopes.y.push_back(static_cast<float>(radius * std::sin(turn)));
  }
  const std::vector<float> steep = {0.0F, 0.5F, -3.0F, 1e4F, -1e12F, 3e38F};
  for (std::size_t i = 0; i < std::min(points / 2, steep.size()); ++i) {
    slopes.x[i] = steep[i];
    slopes.y[points - 1 - i] = steep[i];
  }
  return slopes;
}

struct Case {
  Material material;
  DirectionAngles light;
  double rms;
  DirectionGrid bins;
};
const std::vector<Case> cases = {
    {Mirror{}, {0.0_deg, 0.0_deg}, 0.1, {48, 48}},
    {Dielectric{1.5}, {30.0_deg, 20.0_deg}, 0.25, {48, 32}},
    {Conductor{0.2, 3.0}, {60.0_deg, 130.0_deg}, 0.6, {5, 64}},
    {Dielectric{1.5}, {80.0_deg, -75.0_deg}, 0.5, {64, 64}},  // most facets turned away or send downward
    {Dielectric{1.5}, {80.0_deg, 200.0_deg}, 3.0, {4, 4}},
};

double largest(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0,
                         [](double most, double value) { return std::max(most, std::abs(value)); });
}

// Whole vectors and chunks of points, and what is left of them; several parts.
const std::vector<std::size_t> counts = {1, 2, 7, 127, 128, 129, 1000, 60000};

TEST(LobeKernels, MapIsThatOfTheFormulasPointByPoint) {
  for (const Case& c : cases) {
    const SmoothGrid grid(c.bins);
    const SmoothLobe lobe(grid, c.material, c.light);
    const test::ScalarLobe scalar(grid, c.material, c.light);
    for (const std::size_t count : counts) {
      const Slopes slopes = slopes_of(count, c.rms);
      const DirectionMap found = lobe.map(slopes.x, slopes.y), expected = scalar.map(slopes.x, slopes.y);
      const double top = largest(expected);
      // Rounding only: relative to each bin, but for bins that hold nearly nothing.
      for (std::size_t k = 0; k < found.size(); ++k)
        EXPECT_NEAR(found[k], expected[k], 1e-11 * expected[k] + 1e-15 * top) << count << " points, bin " << k;
    }
  }
}

TEST(LobeKernels, DerivativesAreThoseOfTheFormulasPointByPoint) {
  for (const Case& c : cases) {
    const SmoothGrid grid(c.bins);
    const RandomStream stream(4, RandomPurpose::Test);
    std::vector<double> figure(c.bins.size());
    for (std::size_t k = 0; k < figure.size(); ++k) figure[k] = stream.uniform4(k)[0] - 0.5;
    for (const std::size_t count : counts) {
      const Slopes slopes = slopes_of(count, c.rms);
      // What stands there stays: the derivatives are added.
      std::vector<float> x(count, 0.25F), y(count, -0.5F), expected_x = x, expected_y = y;
      SmoothLobe(grid, c.material, c.light).add_slope_derivatives(slopes.x, slopes.y, figure, 3.0, x, y);
      test::ScalarLobe(grid, c.material, c.light)
          .add_slope_derivatives(slopes.x, slopes.y, figure, 3.0, expected_x, expected_y);
      for (std::size_t i = 0; i < count; ++i) {
        // Two roundings to float, of the derivative and of the sum.
        EXPECT_NEAR(x[i], expected_x[i], 2e-7 * std::abs(expected_x[i])) << count << " points, point " << i;
        EXPECT_NEAR(y[i], expected_y[i], 2e-7 * std::abs(expected_y[i])) << count << " points, point " << i;
      }
    }
  }
}

// At light near the horizon: only facets that reflect upward count, and theirs are the differences of the map.
TEST(LobeKernels, DerivativesAreThoseOfDifferencesUnderGrazingLight) {
  const SmoothGrid grid({32, 32});
  const RandomStream stream(8, RandomPurpose::Test);
  std::vector<double> figure(32 * 32);
  for (std::size_t k = 0; k < figure.size(); ++k) figure[k] = stream.uniform4(k)[0];
  const SmoothLobe lobe(grid, Dielectric{1.5}, {80.0_deg, 25.0_deg});
  const auto value_at = [&](float p, float q) {
    const std::vector<float> x = {p}, y = {q};
    const DirectionMap map = lobe.map(x, y);
    return std::inner_product(map.begin(), map.end(), figure.begin(), 0.0);
  };
  const float step = 0x1p-13F;
  std::size_t lit = 0;
  for (std::size_t i = 0; i < 200; ++i) {
    const auto u = stream.uniform4(1000 + i);
    const float p = std::round(1024.0F * static_cast<float>(u[0] - 0.7)) / 1024.0F;
    const float q = std::round(1024.0F * static_cast<float>(u[1] - 0.6)) / 1024.0F;
    std::vector<float> x = {p}, y = {q}, toward_x = {0.0F}, toward_y = {0.0F};
    lobe.add_slope_derivatives(x, y, figure, 1.0, toward_x, toward_y);
    if (value_at(p, q) == 0.0) {
      EXPECT_EQ(toward_x[0], 0.0F);
      EXPECT_EQ(toward_y[0], 0.0F);
      continue;
    }
    ++lit;
    const double scale = std::hypot(toward_x[0], toward_y[0]);
    const double by_x = (value_at(p + step, q) - value_at(p - step, q)) / (2.0 * step);
    const double by_y = (value_at(p, q + step) - value_at(p, q - step)) / (2.0 * step);
    // The second derivative of the splines jumps from bin to bin: half a step of it where one lies between.
    EXPECT_NEAR(toward_x[0], by_x, 3e-3 * scale) << p << ' ' << q;
    EXPECT_NEAR(toward_y[0], by_y, 3e-3 * scale) << p << ' ' << q;
  }
  EXPECT_GT(lit, 50U);
  EXPECT_LT(lit, 190U);
}

TEST(LobeKernels, GiveTheSameBitsWithEveryInstructionSet) {
  const Case& c = cases[1];
  const SmoothLobe lobe(SmoothGrid(c.bins), c.material, c.light);
  const Slopes slopes = slopes_of(1000, c.rms);
  const std::vector<double> figure(c.bins.size(), 1.0);
  const auto derivatives = [&] {
    std::vector<float> x(1000, 0.0F), y(1000, 0.0F);
    lobe.add_slope_derivatives(slopes.x, slopes.y, figure, 1.0, x, y);
    x.insert(x.end(), y.begin(), y.end());
    return x;
  };
  const DirectionMap best_map = lobe.map(slopes.x, slopes.y);
  const std::vector<float> best = derivatives();
  for (const std::int64_t target : std::vector<std::int64_t>{HWY_EMU128, HWY_SSE4, HWY_AVX2, HWY_AVX3}) {
    if ((hwy::SupportedTargets() & target) == 0) continue;  // not on this machine
    hwy::SetSupportedTargetsForTest(target);
    const DirectionMap map = lobe.map(slopes.x, slopes.y);
    const std::vector<float> found = derivatives();
    hwy::SetSupportedTargetsForTest(0);
    EXPECT_EQ(map, best_map) << hwy::TargetName(target);
    EXPECT_EQ(found, best) << hwy::TargetName(target);
  }
}

TEST(LobeKernels, RefuseEverySlopeThatIsNotFinite) {
  const SmoothLobe lobe(SmoothGrid({16, 16}), Mirror{}, {20.0_deg, 0.0_deg});
  const float infinity = std::numeric_limits<float>::infinity();
  for (const float broken : {infinity, -infinity, std::nanf("")}) {
    for (const std::size_t at : {0U, 15U, 16U}) {
      std::vector<float> some(17, 0.1F), fine(17, 0.0F);
      some[at] = broken;
      EXPECT_THROW((void)lobe.map(some, fine), InvalidInput);
      EXPECT_THROW((void)lobe.map(fine, some), InvalidInput);
    }
  }
}

}  // namespace
}  // namespace mezzotint
