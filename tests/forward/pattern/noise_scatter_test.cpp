#include "forward/pattern/noise_scatter.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <hwy/targets.h>
#include <tbb/global_control.h>

#include "forward/base/error.h"
#include "forward/pattern/sparse_noise.h"

namespace mezzotint {
namespace {

const Grid grid{150, 131, 1.5_um, 2.0_um};

// Turned, stretched and away from the origin: columns and rows are not perpendicular in the noise's units.
PatternMap oblique(double scale) {
  PatternMap map = in_units(turned({}, 37.0_deg), scale, 3.3 * scale);
  map.u0 = -7.4;
  map.v0 = 1234.6;
  return map;
}

std::vector<float> scattered(const PatternMap& map, double z = 0.25, CellHash hash = CellHash::Integer) {
  std::vector<float> values(grid.size(), 0.0F);
  add_sparse_noise(values, grid, map, NoiseLattice(3, hash), z, 1.0);
  return values;
}

TEST(NoiseScatter, IsTheNoisePointByPoint) {
  // From less than a sample a cell (summed around each sample) to cells that are wider than the grid.
  for (const double scale : {0.7, 4.0, 40.0, 700.0}) {
    for (const CellHash hash : {CellHash::Integer, CellHash::Slides}) {
      const PatternMap map = oblique(scale);
      const std::vector<float> values = scattered(map, 0.25, hash);
      for (std::size_t i = 0; i < values.size(); i += 97) {
        const auto [u, v] =
            map(static_cast<double>(i % grid.columns) * 1.5, static_cast<double>(i / grid.columns) * 2.0);
        // Single precision: some 60 terms below 1, each rounded by 6e-8.
        EXPECT_NEAR(values[i], sparse_noise(u, v, 0.25, 3, hash), 2e-6) << scale;
      }
    }
  }
}

TEST(NoiseScatter, HasTheGradientPointByPointAndTheSameBitsWithIt) {
  for (const double scale : {0.7, 4.0, 40.0, 700.0}) {
    const PatternMap map = oblique(scale);
    const NoiseLattice lattice(3, CellHash::Integer);
    std::vector<float> values(grid.size(), 0.0F), toward_u = values, toward_v = values;
    add_sparse_noise(values, grid, map, lattice, 0.25, 1.0, toward_u, toward_v);
    EXPECT_EQ(values, scattered(map)) << scale;
    for (std::size_t i = 0; i < values.size(); i += 97) {
      const auto [u, v] = map(static_cast<double>(i % grid.columns) * 1.5, static_cast<double>(i / grid.columns) * 2.0);
      const auto [along_u, along_v] = sparse_noise_gradient(lattice, u, v, 0.25);
      // Terms below 4 a cell, of which the largest are sums of columns and rows that nearly cancel.
      EXPECT_NEAR(toward_u[i], along_u, 2e-5) << scale;
      EXPECT_NEAR(toward_v[i], along_v, 2e-5) << scale;
    }
  }
}

TEST(NoiseScatter, GivesTheSameBitsWithAnyNumberOfThreads) {
  const std::vector<float> with_many = scattered(oblique(40.0));
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(scattered(oblique(40.0)), with_many);
}

TEST(NoiseScatter, GivesTheSameBitsWithEveryInstructionSet) {
  for (const double scale : {4.0, 40.0, 700.0}) {
    const std::vector<float> best = scattered(oblique(scale));
    for (const std::int64_t target : {HWY_AVX3, HWY_AVX2, HWY_SCALAR}) {
      if ((hwy::SupportedTargets() & target) == 0) continue;  // not on this machine
      hwy::SetSupportedTargetsForTest(target);
      const std::vector<float> with_target = scattered(oblique(scale));
      hwy::SetSupportedTargetsForTest(0);
      EXPECT_EQ(with_target, best) << hwy::TargetName(target) << " " << scale;
    }
  }
}

TEST(NoiseScatter, LeavesMissingSamplesMissing) {
  std::vector<float> values(grid.size(), 1.0F);
  values[77] = std::numeric_limits<float>::quiet_NaN();
  add_sparse_noise(values, grid, oblique(40.0), NoiseLattice(3, CellHash::Integer), 0.0, 1.0);
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(std::isnan(values[i]), i == 77);
}

TEST(NoiseScatter, RefusesWhatTheLatticeDoesNotHold) {
  for (const double far : {1.1e6, 1e300, std::numeric_limits<double>::quiet_NaN()}) {
    PatternMap map = oblique(40.0);
    map.u0 = far;
    EXPECT_THROW((void)scattered(map), InvalidInput) << far;
  }
}

}  // namespace
}  // namespace mezzotint
