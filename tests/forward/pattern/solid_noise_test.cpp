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

}  // namespace
}  // namespace mezzotint
