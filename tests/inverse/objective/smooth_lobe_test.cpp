#include "inverse/objective/smooth_lobe.h"

#include <cmath>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "forward/base/error.h"
#include "forward/base/random.h"
#include "forward/scattering/slope_splat.h"
#include "forward/surface/slope_covariance.h"

namespace mezzotint {
namespace {

const DirectionAngles oblique{20.0_deg, 35.0_deg};

// Two crossed waves of RMS slope near 0.2.
HeightField waves(std::size_t side, Continuation continuation) {
  HeightField relief({side, side, 1.0_um, 1.3_um}, continuation);
  for (std::size_t row = 0; row < side; ++row) {
    for (std::size_t column = 0; column < side; ++column) {
      const double u = 2.0 * std::numbers::pi * double(column) / double(side);
      const double v = 2.0 * std::numbers::pi * double(row) / double(side);
      relief.at(column, row) =
          static_cast<float>(0.02 * double(side) * (std::sin(2.0 * u + v) + 0.7 * std::cos(3.0 * v - u)));
    }
  }
  return relief;
}

// Slopes of its facets, one pair each.
struct Slopes {
  std::vector<float> x, y;
};
Slopes slopes_of(const HeightField& relief) {
  Slopes slopes;
  for_each_facet_slope(relief, [&](double p, double q) {
    slopes.x.push_back(static_cast<float>(p));
    slopes.y.push_back(static_cast<float>(q));
  });
  return slopes;
}

DirectionMap map_of(const SmoothLobe& lobe, const HeightField& relief) {
  const Slopes slopes = slopes_of(relief);
  return lobe.map(slopes.x, slopes.y);
}

double light_of(const SmoothGrid& grid, const DirectionMap& map) {
  return std::inner_product(map.begin(), map.end(), grid.areas().begin(), 0.0);
}

TEST(SmoothGrid, AreasSumToThatOfTheDisc) {
  const SmoothGrid grid({24, 16});
  EXPECT_NEAR(std::accumulate(grid.areas().begin(), grid.areas().end(), 0.0), std::numbers::pi, 1e-12);
}

TEST(SmoothGrid, SharesAreASmoothPartitionOfOne) {
  for (const double x : {0.0, 0.3, 0.999, 1.0, 4.5, 6.2, 7.999, 8.0}) {
    const SoftBins bins = soft_bins(x, 8);
    EXPECT_NEAR(bins.share[0] + bins.share[1] + bins.share[2], 1.0, 1e-15);
    EXPECT_NEAR(bins.slope[0] + bins.slope[1] + bins.slope[2], 0.0, 1e-15);
    const SoftBins up = soft_bins(x + 1e-7, 8);
    if (up.bin != bins.bin || x < 1.0) continue;
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR((up.share[k] - bins.share[k]) / 1e-7, bins.slope[k], 1e-6);
  }
  // Across the border of two bins nothing jumps.
  const SoftBins below = soft_bins(3.0 - 1e-9, 8), above = soft_bins(3.0 + 1e-9, 8);
  EXPECT_NEAR(below.share[2], above.share[1], 1e-8);
  EXPECT_NEAR(below.share[1], above.share[0], 1e-8);
}

TEST(SmoothLobe, ReflectsAsMuchLightAsTheHardBinsDo) {
  const DirectionGrid bins{32, 32};
  const SmoothGrid grid(bins);
  const auto hard_areas = projected_solid_angles(bins);
  for (const Material& material : {Material(Mirror{}), Material(Dielectric{1.5}), Material(Conductor{0.2, 3.0})}) {
    const HeightField relief = waves(96, Continuation::Periodic);
    const DirectionMap hard = slope_reflection_map(relief, material, oblique, bins);
    const double expected = std::inner_product(hard.begin(), hard.end(), hard_areas.begin(), 0.0);
    // Fresnel from a cubic through 2048 steps, and single precision in the other one.
    EXPECT_NEAR(light_of(grid, map_of(SmoothLobe(grid, material, oblique), relief)), expected, 1e-6 * expected);
  }
}

TEST(SmoothLobe, HasTheMomentsOfWhatItsFacetsReflect) {
  const DirectionGrid bins{32, 32};
  const SmoothGrid grid(bins);
  const HeightField relief = waves(64, Continuation::Mirrored);
  const Direction light = to_direction(oblique);
  double sum = 0.0, mean = 0.0, square = 0.0, facets = 0.0;
  for_each_facet_slope(relief, [&](double p, double q) {
    const Direction m = Direction(-p, -q, 1.0).normalized();
    const Direction out = 2.0 * light.dot(m) * m - light;
    ++facets;
    const double weight = light.dot(m) / (m.z() * light.z());
    sum += weight;
    mean += weight * out.x();
    square += weight * out.x() * out.x();
  });
  const DirectionMap map = map_of(SmoothLobe(grid, Mirror{}, oblique), relief);
  double soft_sum = 0.0, soft_mean = 0.0, soft_square = 0.0;
  for (std::size_t k = 0; k < map.size(); ++k) {
    const double x = (double(k % 32) + 0.5) / 16.0 - 1.0, weight = grid.areas()[k] * map[k];
    soft_sum += weight;
    soft_mean += weight * x;
    soft_square += weight * x * x;
  }
  // A quadratic B-spline reproduces straight lines and adds a quarter of a squared bin to a square, exactly but for
  // slopes in float.
  EXPECT_NEAR(soft_sum, sum / facets, 1e-9);
  EXPECT_NEAR(soft_mean, mean / facets, 1e-9);
  EXPECT_NEAR(soft_square, (square + 0.25 / 256.0 * sum) / facets, 1e-9);
}

// A smooth lobe, off the middle.
double smooth_lobe(const Direction& d) {
  return std::exp(-0.5 * (std::pow((d.x() - 0.2) / 0.15, 2) + std::pow((d.y() + 0.1) / 0.2, 2)));
}

TEST(SmoothGrid, SoftensAMapOfHardBinsBetterThanToTheSecondOrder) {
  const auto error = [](std::size_t side) {
    const SmoothGrid grid({side, side});
    const DirectionMap softened = grid.softened(average_over_bins(grid.grid(), smooth_lobe, 8));
    // The same by the definition, from bins forty times as fine.
    const DirectionGrid fine{40 * side, 40 * side};
    const DirectionMap values = average_over_bins(fine, smooth_lobe, 1);
    const std::vector<double> areas = projected_solid_angles(fine);
    DirectionMap exact(side * side, 0.0);
    for (std::size_t k = 0; k < fine.size(); ++k) {
      const SoftBins u = soft_bins((double(k % fine.width) + 0.5) / 40.0, side);
      const SoftBins v = soft_bins((double(k / fine.width) + 0.5) / 40.0, side);
      for (std::size_t j = 0; j < 3; ++j) {
        for (std::size_t i = 0; i < 3; ++i)
          exact[v.bin[j] * side + u.bin[i]] += values[k] * areas[k] * u.share[i] * v.share[j];
      }
    }
    double worst = 0.0;
    for (std::size_t k = 0; k < exact.size(); ++k) {
      const double light = exact[k] - grid.areas()[k] * softened[k];  // slivers on the rim count for what they hold
      worst = std::max(worst, std::abs(light) * double(side * side) / 4.0);
    }
    return worst;
  };
  const double coarse = error(16), fine = error(32);
  EXPECT_LT(fine, 1e-3);
  EXPECT_GT(std::log2(coarse / fine), 3.0);  // 3.3 at bins of nearly σ, toward 4; what is left out here falls by 2
}

TEST(SmoothLobe, DerivativesTowardSlopesAreThoseOfDifferences) {
  const SmoothGrid grid({24, 24});
  const RandomStream stream(4, RandomPurpose::Test);
  std::vector<double> figure(24 * 24);
  for (std::size_t k = 0; k < figure.size(); ++k) figure[k] = stream.uniform4(k)[0];
  for (const Material& material : {Material(Mirror{}), Material(Dielectric{1.5})}) {
    const SmoothLobe lobe(grid, material, oblique);
    const Slopes slopes = slopes_of(waves(40, Continuation::Periodic));
    const std::size_t points = slopes.x.size();
    std::vector<float> toward_x(points), toward_y(points);
    lobe.add_slope_derivatives(slopes.x, slopes.y, figure, 2.0, toward_x, toward_y);
    const auto moved = [&](double step) {
      Slopes other = slopes;
      for (std::size_t i = 0; i < points; ++i) {
        other.x[i] += static_cast<float>(step * (stream.uniform4(i)[1] - 0.4));
        other.y[i] += static_cast<float>(step * (stream.uniform4(i)[2] - 0.6));
      }
      return other;
    };
    const auto j = [&](const Slopes& s) {
      const DirectionMap map = lobe.map(s.x, s.y);
      return std::inner_product(map.begin(), map.end(), figure.begin(), 0.0);
    };
    // Small steps, since the second derivative of the splines jumps; the differences of the floats as they are.
    const Slopes up = moved(1e-4), down = moved(-1e-4);
    double found = 0.0;
    for (std::size_t i = 0; i < points; ++i) {
      found += double(toward_x[i]) * (double(up.x[i]) - double(down.x[i]));
      found += double(toward_y[i]) * (double(up.y[i]) - double(down.y[i]));
    }
    const double expected = 2.0 * (j(up) - j(down));
    EXPECT_NEAR(found, expected, 3e-5 * std::abs(expected));
  }
}

TEST(SmoothLobe, GivesTheSameBitsWithAnyNumberOfThreads) {
  const SmoothGrid grid({16, 16});
  const SmoothLobe lobe(grid, Mirror{}, oblique);
  const HeightField relief = waves(70, Continuation::Periodic);
  const DirectionMap many = map_of(lobe, relief);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(map_of(lobe, relief), many);
}

TEST(SmoothLobe, RefusesWhatHasNoLobe) {
  const SmoothGrid grid({16, 16});
  EXPECT_THROW(SmoothLobe(grid, Mirror{}, {90.0_deg, 0.0_deg}), InvalidInput);
  const SmoothLobe lobe(grid, Mirror{}, oblique);
  const std::vector<float> flat(4, 0.0F), broken = {0.0F, std::nanf(""), 0.0F, 0.0F};
  EXPECT_THROW((void)lobe.map(broken, flat), InvalidInput);
  EXPECT_THROW((void)lobe.map({}, {}), InvalidInput);
  EXPECT_THROW(SmoothGrid({2, 64}), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
