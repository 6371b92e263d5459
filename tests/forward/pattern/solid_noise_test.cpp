#include <cmath>

#include <gtest/gtest.h>

#include "forward/base/random.h"
#include "forward/pattern/pattern.h"
#include "forward/pattern/solid_noise.h"
#include "forward/pattern/sparse_noise.h"

namespace mezzotint {
namespace {

TEST(SolidNoise, IsTheNoisePointByPoint) {
  const RandomStream stream(5, RandomPurpose::Test);
  for (const CellHash hash : {CellHash::Integer, CellHash::Slides}) {
    SolidNoise noise(7, hash);
    const NoiseLattice lattice(7, hash);
    for (std::uint64_t i = 0; i < 3000; ++i) {
      const auto u = stream.uniform4(i);
      // Far from one another and from the origin, and twice the same place.
      const double x = 2000.0 * u[0] - 1000.0, y = 60.0 * u[1] - 30.0, z = 9.0 * u[2];
      const double expected = sparse_noise(lattice, x, y, z);
      EXPECT_NEAR(noise(x, y, z), expected, 4e-6);
      EXPECT_NEAR(noise(x + 1e-9, y, z), expected, 4e-6);
    }
  }
}

template <class Kind>
void expect_plane(Kind kind) {
  const Grid grid{40, 30, 7.0_um, 5.0_um};
  const HeightField plane = synthesize(kind, grid);
  SolidPattern solid(kind);
  for (std::size_t r = 0; r < grid.rows; ++r) {
    for (std::size_t c = 0; c < grid.columns; ++c) {
      const double gray = solid.gray(7.0 * static_cast<double>(c), 5.0 * static_cast<double>(r), 0.0);
      EXPECT_NEAR(kind.height.um() * gray, double(plane.at(c, r)), 2e-3);
    }
  }
}

TEST(SolidNoise, IsThePatternOfThePlaneAtItsFoot) {
  expect_plane(Noise{.scale = 60.0_um, .seed = 3});
  expect_plane(FractionalBrownianMotion{.scale = 150.0_um, .seed = 4});
  expect_plane(Turbulence{.scale = 150.0_um, .seed = 5});
}

struct Moments {
  double deviation, slope_along, slope_across;
};
template <class Value>
Moments moments_of(const Value& value) {
  constexpr double step = 0.05;
  const RandomStream stream(9, RandomPurpose::Test);
  double squares = 0.0, along = 0.0, across = 0.0;
  constexpr std::uint64_t count = 6000;
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto u = stream.uniform4(i);
    const double x = 300.0 * u[0], y = 300.0 * u[1], z = 300.0 * u[2];
    const double here = value(x, y, z);
    squares += here * here;
    along += std::pow((value(x, y + step, z) - here) / step, 2.0);
    across += std::pow((value(x + step, y, z) - here) / step, 2.0);
  }
  return {std::sqrt(squares / count), std::sqrt(along / count), std::sqrt(across / count)};
}

// Drawn out along y: the deviation stays, slopes along y fall by the stretch.
TEST(SolidNoise, IsDrawnOut) {
  SolidNoise noise(3, CellHash::Integer);
  const Moments round = moments_of([&](double x, double y, double z) { return noise(x, y, z); });
  EXPECT_NEAR(round.deviation, std::sqrt(noise_variance), 0.03 * round.deviation);
  for (const double stretch : {1.0, 2.5, 6.0}) {
    const Moments drawn = moments_of([&](double x, double y, double z) {
      return noise.stretched({x, y, z}, {0, 1, 0}, stretch);
    });
    EXPECT_NEAR(drawn.deviation, round.deviation, 0.06 * round.deviation) << stretch;
    EXPECT_NEAR(drawn.slope_across, round.slope_across, 0.06 * round.slope_across) << stretch;
    EXPECT_NEAR(drawn.slope_along, round.slope_along / stretch, 0.06 * round.slope_along / stretch) << stretch;
  }
  EXPECT_NEAR(noise.stretched({4.3, 7.7, 1.2}, {0, 0, 1}, 1.0), noise(4.3, 7.7, 1.2), 1e-5);
}

TEST(SolidNoise, IsSmeared) {
  SolidNoise noise(3, CellHash::Integer);
  const Moments lines = moments_of([&](double x, double y, double z) {
    return noise.smeared({x, y, z}, {0, 1, 0}, 10.0);
  });
  EXPECT_NEAR(lines.deviation, std::sqrt(noise_variance), 0.07 * lines.deviation);
  EXPECT_LT(lines.slope_along, 0.16 * lines.slope_across);  // √2·σ·amplitude/length: 0.09 of 0.64
  // The mean by many steps; what brings it back to the noise's deviation is the same everywhere.
  const std::array<double, 3> along = {0.6, -0.48, 0.64};
  const auto mean_at = [&](double x) {
    double sum = 0.0;
    for (int i = 0; i < 2000; ++i) {
      const double way = 3.0 * ((i + 0.5) / 2000 - 0.5);
      sum += noise(x + way * along[0], 2.2 + way * along[1], 7.7 + way * along[2]) / 2000;
    }
    return sum;
  };
  const double amplitude = noise.smeared({1.3, 2.2, 7.7}, along, 3.0) / mean_at(1.3);
  EXPECT_GT(amplitude, 1.0);
  for (const double x : {4.1, 5.9, 8.0})
    EXPECT_NEAR(noise.smeared({x, 2.2, 7.7}, along, 3.0), amplitude * mean_at(x), 2e-5);
}

}  // namespace
}  // namespace mezzotint
