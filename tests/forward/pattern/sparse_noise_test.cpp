#include "forward/pattern/sparse_noise.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "forward/base/random.h"
#include "forward/pattern/noise_scatter.h"
#include "forward/surface/slope_covariance.h"

namespace mezzotint {
namespace {

struct Moments {
  double variance = 0.0;
  double gradient_square = 0.0;
};

// Means over 8 planes at the same place between the lattice's planes; each shows 64 × 64 cells of 32 × 32 samples.
Moments sample_moments(double z) {
  const Grid grid{2048, 2048, 1.0_um, 1.0_um};
  Moments moments;
  for (int plane = 0; plane < 8; ++plane) {
    HeightField field(grid, Continuation::Mirrored);
    add_sparse_noise(field.heights_um(), grid, in_units({}, 32.0, 32.0), NoiseLattice(11, CellHash::Integer), z + plane,
                     1.0);
    for (const float value : field.heights_um()) moments.variance += static_cast<double>(value) * value;
    const SlopeCovariance slopes = slope_covariance(field);
    moments.gradient_square += (slopes.xx + slopes.yy) * 32.0 * 32.0;
  }
  return {moments.variance / (8.0 * static_cast<double>(grid.size())), moments.gradient_square / 8.0};
}

TEST(SparseNoise, HasTheClosedFormMomentsOnTheLatticePlane) {
  // 32,000 cells of about four independent values: standard error of a variance √(2.6/1.3e5) = 0.45 %; 1.5 % is three
  // of them and what differences over 1/32 of a cell lose of the slopes (0.3 %). The cell means (.02188, .8365) lie 3 %
  // and .7 % off.
  const Moments moments = sample_moments(0.0);
  EXPECT_NEAR(moments.variance, noise_variance_at_z0, 0.015 * noise_variance_at_z0);
  EXPECT_NEAR(moments.gradient_square, noise_plane_gradient_square_at_z0, 0.015 * noise_plane_gradient_square_at_z0);
}

TEST(SparseNoise, HasTheClosedFormMomentsHalfWayBetweenLatticePlanes) {
  const Moments moments = sample_moments(0.5);
  EXPECT_NEAR(moments.variance, 0.02150, 0.015 * 0.02150);
  EXPECT_NEAR(moments.gradient_square, 0.8332, 0.015 * 0.8332);
}

TEST(SparseNoise, DrawsItsImpulsesFromTheStreamOfItsSeed) {
  CellImpulses drawn;
  for (const std::uint64_t index : {std::uint64_t{0}, std::uint64_t{123456789}, ~std::uint64_t{0}}) {
    draw_impulses(0xFEDCBA9876543210U, index, drawn);
    const RandomStream stream(0xFEDCBA9876543210U, RandomPurpose::PatternImpulse);
    for (std::size_t j = 0; j < CellImpulses::count; ++j) {
      const auto u = stream.uniform4(index, static_cast<std::uint32_t>(j));
      EXPECT_EQ(drawn.x[j], u[0]);
      EXPECT_EQ(drawn.y[j], u[1]);
      EXPECT_EQ(drawn.z[j], u[2]);
      EXPECT_EQ(drawn.weight[j], j % 2 == 0 ? u[3] : -u[3]);
    }
  }
}

TEST(SparseNoise, RepeatsWithTheSlidesHashAtTheirLatticeShiftsAndNotWithOurs) {
  // All that are listed for the slides' q·(1, 1000, 576).
  constexpr int shifts[6][3] = {{32, 4, -7}, {-24, 15, -26}, {8, 19, -33}, {0, 72, -125}, {576, 0, -1}, {1000, -1, 0}};
  for (const auto& shift : shifts) {
    double largest_difference = 0.0;
    for (int i = 0; i < 20; ++i) {
      const double x = 0.37 * i, y = 0.11 * i, z = 0.05 * i;
      const double x2 = x + shift[0], y2 = y + shift[1], z2 = z + shift[2];
      // Equal but for the rounding of x + 1000.
      EXPECT_NEAR(sparse_noise(x, y, z, 1, CellHash::Slides), sparse_noise(x2, y2, z2, 1, CellHash::Slides), 1e-11);
      largest_difference =
          std::max(largest_difference, std::abs(sparse_noise(x, y, z, 1) - sparse_noise(x2, y2, z2, 1)));
    }
    EXPECT_GT(largest_difference, 0.1) << shift[0];
  }
}

}  // namespace
}  // namespace mezzotint
