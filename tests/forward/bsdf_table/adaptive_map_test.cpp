#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "forward/base/random.h"
#include "tests/forward/bsdf_table/beckmann_table.h"

namespace mezzotint {
namespace {

using test::degrees;
using test::exact;

DirectionMap expanded(const AdaptiveMap& map, const DirectionGrid& grid) {
  DirectionMap values(grid.size());
  for (std::size_t k = 0; k < values.size(); ++k) {
    values[k] = double{map.at_bin(k % grid.width, k / grid.width).value};
  }
  return values;
}

TEST(AdaptiveMap, HoldsTheMapWhereNothingMayBeJoined) {
  for (const DirectionGrid grid : {DirectionGrid{64, 64}, DirectionGrid{33, 20}, DirectionGrid{1, 1}}) {
    const DirectionMap map = reflection_map(BeckmannLobe{0.3, 0.1, {}}, Mirror{}, degrees(50, 20), grid);
    const JoinedMap joined = join_smooth_bins(grid, exact(map), 0.0);
    EXPECT_LT(relative_l2(grid, expanded(joined.map, grid), map), 1e-7);  // floats
    EXPECT_NEAR(joined.map.integral(), test::albedo(grid, map), 1e-7);
  }
}

TEST(AdaptiveMap, JoinsSmoothBinsWithinItsToleranceAndKeepsTheAlbedo) {
  const DirectionGrid grid{128, 128};
  for (const double alpha : {0.03, 0.2, 0.6}) {
    const DirectionMap map = reflection_map(BeckmannLobe{alpha, alpha, {}}, Mirror{}, degrees(40, 20), grid);
    for (const double tolerance : {0.01, 0.05}) {
      const JoinedMap joined = join_smooth_bins(grid, exact(map), tolerance);
      const double seen = relative_l2(grid, expanded(joined.map, grid), map);
      EXPECT_LE(seen, tolerance);
      EXPECT_NEAR(joined.difference, seen, 1e-5);  // floats
      EXPECT_NEAR(joined.map.integral(), test::albedo(grid, map), 1e-7);
      EXPECT_LT(joined.map.square_count(), grid.size() * 3 / 4);
      std::cout << "alpha " << alpha << " tolerance " << tolerance << ": " << joined.map.square_count()
                << " squares of " << grid.size() << ", " << seen << '\n';
    }
  }
}

TEST(AdaptiveMap, TakesNoNoiseForStructure) {
  const DirectionGrid grid;
  MapEstimate flat = exact(DirectionMap(grid.size(), 1.0 / std::numbers::pi));
  const RandomStream stream(3, RandomPurpose::Test);
  constexpr double noise = 0.1;
  for (std::size_t k = 0; k < grid.size(); ++k) {
    const auto normal = stream.normal4(k);
    flat.half_a[k] += noise * normal[0];
    flat.half_b[k] += noise * normal[1];
    flat.mean[k] = 0.5 * (flat.half_a[k] + flat.half_b[k]);
    flat.standard_error[k] = noise / std::sqrt(2.0);
  }
  const JoinedMap joined = join_smooth_bins(grid, flat, 0.05);
  EXPECT_LT(joined.map.square_count(), 200U);
  // The standard error of a square is that of a mean: it falls with the root of its bins.
  const AdaptiveMap::Square middle = joined.map.at(0.1, 0.1);
  EXPECT_NEAR(double{middle.standard_error}, noise / std::sqrt(2.0) / std::pow(2.0, middle.level), 1e-3);
}

TEST(AdaptiveMap, ClipsWhatNoiseMadeNegativeAndKeepsTheAlbedo) {
  const DirectionGrid grid{16, 16};
  DirectionMap map = reflection_map(BeckmannLobe{0.3, 0.3, {}}, Mirror{}, degrees(40, 20), grid);
  const double before = test::albedo(grid, map);
  map[20] = -0.5;
  const JoinedMap joined = join_smooth_bins(grid, exact(map), 0.0);
  EXPECT_NEAR(joined.map.integral(), test::albedo(grid, map), 1e-6);
  EXPECT_GT(joined.clipped_share, 0.0);
  EXPECT_LT(joined.map.integral(), before);
  for (const double value : expanded(joined.map, grid)) EXPECT_GE(value, 0.0);
}

// Uniform in every pixel ∩ disc: mean position of the samples of rim bins, of which some lie in slivers.
TEST(AdaptiveMap, DrawsUniformlyFromBinsThatTheRimCuts) {
  for (const DirectionGrid grid : {DirectionGrid{4, 4}, DirectionGrid{5, 3}}) {
    const AdaptiveMap flat = join_smooth_bins(grid, exact(DirectionMap(grid.size(), 1.0)), 0.0).map;
    EXPECT_NEAR(flat.integral(), std::numbers::pi, 1e-7);
    const RandomStream stream(5, RandomPurpose::Test);
    constexpr std::uint64_t draws = 40000;
    const DirectionGrid fine{24, 24};
    std::vector<double> counts(fine.size(), 0.0);
    for (std::uint64_t k = 0; k < draws; ++k) {
      const auto u = stream.uniform4(k);
      const Eigen::Vector2d point = flat.sample(u[0], u[1]);
      ASSERT_LE(point.norm(), 1.0 + 1e-15);
      counts[fine.bin_of(point.x(), point.y())] += 1.0;
    }
    const std::vector<double> areas = projected_solid_angles(fine);
    double chi_squared = 0.0, bins = 0.0;
    for (std::size_t k = 0; k < counts.size(); ++k) {
      const double expected = static_cast<double>(draws) * areas[k] / std::numbers::pi;
      if (expected < 5.0) continue;
      chi_squared += (counts[k] - expected) * (counts[k] - expected) / expected;
      bins += 1.0;
    }
    // Wilson and Hilferty's quantile at 0.999: z = 3.09; one false alarm in a thousand seeds.
    const double freedom = bins - 1.0, h = 2.0 / (9.0 * freedom);
    EXPECT_LT(chi_squared, freedom * std::pow(1.0 - h + 3.09 * std::sqrt(h), 3.0));
  }
}

TEST(AdaptiveMap, RefusesMapsThatDoNotFitOrAreNoNumbers) {
  const DirectionGrid grid{8, 8};
  MapEstimate map = exact(DirectionMap(64, 1.0));
  map.half_a.pop_back();
  EXPECT_THROW((void)join_smooth_bins(grid, map, 0.01), InvalidInput);
  map = exact(DirectionMap(64, 1.0));
  map.mean[3] = std::nan("");
  EXPECT_THROW((void)join_smooth_bins(grid, map, 0.01), InvalidInput);
  EXPECT_THROW((void)join_smooth_bins(grid, exact(DirectionMap(64, 1.0)), -0.1), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
