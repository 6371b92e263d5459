#include "inverse/objective/lobe_distance.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "forward/base/random.h"

namespace mezzotint {
namespace {

const SmoothGrid grid({64, 64});

struct Gaussian {
  double x = 0.0, y = 0.0, sigma_x = 0.1, sigma_y = 0.1, light = 1.0;
};

// A Gaussian of light in the plane of directions.
DirectionMap lobe(const Gaussian& g) {
  DirectionMap map(64 * 64);
  for (std::size_t k = 0; k < map.size(); ++k) {
    const double x = (double(k % 64) + 0.5) / 32.0 - 1.0 - g.x, y = (double(k / 64) + 0.5) / 32.0 - 1.0 - g.y;
    map[k] = g.light * std::exp(-0.5 * (x * x / (g.sigma_x * g.sigma_x) + y * y / (g.sigma_y * g.sigma_y))) /
             (2.0 * std::numbers::pi * g.sigma_x * g.sigma_y);
  }
  return map;
}

double distance(LobeDistance kind, const DirectionMap& f, const DirectionMap& g) {
  return lobe_distance(kind, grid, f, g).value;
}

TEST(LobeDistance, IsZeroBetweenEqualLobesAndDoesNotKnowTheirUnit) {
  const DirectionMap f = lobe({.x = 0.1, .sigma_y = 0.2}), g = lobe({});
  for (const LobeDistance kind : all_lobe_distances) {
    EXPECT_NEAR(distance(kind, g, g), 0.0, 1e-12) << name_of(kind);
    DirectionMap f_times = f, g_times = g;
    for (double& value : f_times) value *= 1000.0;
    for (double& value : g_times) value *= 1000.0;
    EXPECT_NEAR(distance(kind, f_times, g_times), distance(kind, f, g), 1e-9 * distance(kind, f, g)) << name_of(kind);
  }
}

TEST(LobeDistance, OfShiftedGaussiansIsTheClosedForm) {
  const double d = 0.15, s = 0.1;
  const DirectionMap f = lobe({.x = d * 0.6, .y = d * 0.8}), g = lobe({});
  // ∫(f − g)²/∫g² = 2(1 − e^(−d²/4s²)). Sums over bins of a third of σ are exact to e^(−2π²·10).
  EXPECT_NEAR(distance(LobeDistance::L2, f, g), 2.0 * (1.0 - std::exp(-d * d / (4.0 * s * s))), 1e-9);
  // ∛ of a Gaussian is one of √3·σ; the millionth that is added to both changes their flanks.
  EXPECT_NEAR(distance(LobeDistance::CubeRoot, f, g), 2.0 * (1.0 - std::exp(-d * d / (12.0 * s * s))), 2e-3);
  EXPECT_NEAR(distance(LobeDistance::Moments, f, g), d * d / (s * s), 1e-4);  // bins add a 12th of their square
  // A shift costs d²·cos² along an axis; its mean over axes is d²/2, in units of (σ² + bin²/12). On the four axes of 16
  // along which bins lie one behind the other, light moves in whole steps: up to bin²/4 more, 6e-3 in the mean.
  EXPECT_NEAR(distance(LobeDistance::Wasserstein, f, g), 0.5 * d * d / (s * s + 1.0 / (12.0 * 1024.0)), 6e-3);
}

TEST(LobeDistance, OfWiderGaussiansIsTheClosedForm) {
  const DirectionMap f = lobe({.sigma_x = 0.14}), g = lobe({});
  EXPECT_NEAR(distance(LobeDistance::Moments, f, g), std::pow(std::log(0.14 * 0.14 / 0.01), 2), 1e-3);
  // Between Gaussians on a line (σ₁ − σ₂)²; σ along an axis at angle a is √(σ_x² cos² + σ_y² sin²).
  double mean = 0.0;
  for (int k = 0; k < 16; ++k) {
    const double a = std::numbers::pi * k / 16.0;
    mean += std::pow(std::hypot(0.14 * std::cos(a), 0.1 * std::sin(a)) - 0.1, 2) / 16.0;
  }
  EXPECT_NEAR(distance(LobeDistance::Wasserstein, f, g), mean / (0.01 + 1.0 / (12.0 * 1024.0)), 6e-3);
}

TEST(LobeDistance, OfABrighterLobeIsTheClosedForm) {
  const DirectionMap f = lobe({.light = 2.0}), g = lobe({});
  EXPECT_NEAR(distance(LobeDistance::L2, f, g), 1.0, 1e-12);
  EXPECT_NEAR(distance(LobeDistance::CubeRoot, f, g), std::pow(std::cbrt(2.0) - 1.0, 2), 2e-3);
  EXPECT_NEAR(distance(LobeDistance::Moments, f, g), std::pow(std::log(2.0), 2), 1e-12);
  EXPECT_NEAR(distance(LobeDistance::Wasserstein, f, g), std::pow(std::log(2.0), 2), 1e-12);
}

TEST(LobeDistance, SlopesAreThoseOfDifferences) {
  const RandomStream stream(6, RandomPurpose::Test);
  DirectionMap f = lobe({.x = 0.1, .sigma_x = 0.2, .sigma_y = 0.15}), g = lobe({.sigma_x = 0.17});
  for (std::size_t k = 0; k < f.size(); ++k) {
    f[k] *= 0.5 + stream.uniform4(k)[0];
    g[k] *= 0.5 + stream.uniform4(k)[1];
  }
  for (const LobeDistance kind : all_lobe_distances) {
    const DistanceWithSlopes at = lobe_distance(kind, grid, f, g);
    for (const int lane : {2, 3}) {
      const auto moved = [&](double step) {
        DirectionMap other = f;
        for (std::size_t k = 0; k < f.size(); ++k)
          other[k] *= 1.0 + step * (stream.uniform4(k)[std::size_t(lane)] - 0.5);
        return distance(kind, other, g);
      };
      double found = 0.0;
      for (std::size_t k = 0; k < f.size(); ++k)
        found += at.slopes[k] * f[k] * (stream.uniform4(k)[std::size_t(lane)] - 0.5);
      const double expected = (8.0 * (moved(1e-3) - moved(-1e-3)) - (moved(2e-3) - moved(-2e-3))) / 12e-3;
      EXPECT_NEAR(found, expected, 1e-4 * std::abs(expected)) << name_of(kind);
    }
  }
}

TEST(LobeDistance, OfABinWithoutLightHasASlopeTowardIt) {
  DirectionMap f = lobe({.sigma_x = 0.05, .sigma_y = 0.05}), g = lobe({});
  for (double& value : f) value = value < 1e-3 ? 0.0 : value;
  for (const LobeDistance kind : all_lobe_distances) {
    for (const double slope : lobe_distance(kind, grid, f, g).slopes)
      ASSERT_TRUE(std::isfinite(slope)) << name_of(kind);
  }
}

TEST(LobeDistance, RefusesWhatIsNoLobe) {
  const DirectionMap g = lobe({});
  for (const LobeDistance kind : all_lobe_distances) {
    EXPECT_THROW((void)distance(kind, DirectionMap(64 * 64, 0.0), g), InvalidInput);
    EXPECT_THROW((void)distance(kind, g, DirectionMap(63 * 64, 1.0)), InvalidInput);
    DirectionMap negative = g;
    negative[7] = -1.0;
    EXPECT_THROW((void)distance(kind, negative, g), InvalidInput);
  }
}

}  // namespace
}  // namespace mezzotint
