#include "forward/pattern/sparse_noise.h"

#include <cmath>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "forward/base/random.h"

namespace mezzotint {
namespace {

struct Moments {
  double variance = 0.0;
  double gradient_square = 0.0;
  double mean = 0.0;
};

// Means over random points of many cells; gradients by central differences in the plane.
Moments sample_moments(double z, std::uint64_t points) {
  const RandomStream stream(7, RandomPurpose::Test);
  const double step = 1e-3, extent = 400.0;
  const NoisePlane plane(11, CellHash::Integer, z, {-1.0, extent + 1.0, -1.0, extent + 1.0});
  Moments moments;
  for (std::uint64_t i = 0; i < points; ++i) {
    const auto u = stream.uniform4(i);
    const double x = u[0] * extent, y = u[1] * extent;
    const double value = plane(x, y);
    const double dx = (plane(x + step, y) - plane(x - step, y)) / (2.0 * step);
    const double dy = (plane(x, y + step) - plane(x, y - step)) / (2.0 * step);
    moments.mean += value;
    moments.variance += value * value;
    moments.gradient_square += dx * dx + dy * dy;
  }
  const auto n = static_cast<double>(points);
  return {moments.variance / n, moments.gradient_square / n, moments.mean / n};
}

TEST(SparseNoise, HasTheClosedFormMomentsOnTheLatticePlane) {
  // 160,000 cells of about four independent values: standard error of a variance √(2/6e5)·(kurtosis) < 0.4 %;
  // 1.5 % is four of them. The cell means (.02188, .8365) lie 3 % and .7 % off and would be a fault.
  const Moments moments = sample_moments(0.0, 400'000);
  EXPECT_NEAR(moments.variance, noise_variance_at_z0, 0.015 * noise_variance_at_z0);
  EXPECT_NEAR(moments.gradient_square, noise_plane_gradient_square_at_z0, 0.015 * noise_plane_gradient_square_at_z0);
}

TEST(SparseNoise, HasTheClosedFormMomentsHalfWayBetweenLatticePlanes) {
  const Moments moments = sample_moments(0.5, 400'000);
  EXPECT_NEAR(moments.variance, 0.02150, 0.015 * 0.02150);
  EXPECT_NEAR(moments.gradient_square, 0.8332, 0.015 * 0.8332);
}

TEST(SparseNoise, IsTheSameOnAPlaneAsPointByPoint) {
  const NoisePlane plane(3, CellHash::Integer, 0.25, {-20.0, 20.0, -20.0, 20.0});
  const RandomStream stream(9, RandomPurpose::Test);
  for (std::uint64_t i = 0; i < 200; ++i) {
    const auto u = stream.uniform4(i);
    const double x = 40.0 * u[0] - 20.0, y = 40.0 * u[1] - 20.0;
    // Single precision within a cell: 120 terms of at most 1, rounding 6e-8 each.
    EXPECT_NEAR(plane(x, y), sparse_noise(x, y, 0.25, 3), 2e-6);
  }
}

TEST(SparseNoise, RepeatsWithTheSlidesHashAtTheirLatticeShiftAndNotWithOurs) {
  double largest_difference = 0.0;
  for (int i = 0; i < 50; ++i) {
    const double x = 0.37 * i, y = 0.11 * i, z = 0.05 * i;
    // Equal but for the rounding of x + 32.
    EXPECT_NEAR(sparse_noise(x, y, z, 1, CellHash::Slides),
                sparse_noise(x + 32.0, y + 4.0, z - 7.0, 1, CellHash::Slides), 1e-12);
    largest_difference =
        std::max(largest_difference, std::abs(sparse_noise(x, y, z, 1) - sparse_noise(x + 32.0, y + 4.0, z - 7.0, 1)));
  }
  EXPECT_GT(largest_difference, 0.1);
}

TEST(SparseNoise, RefusesAPlaneWithTooManyCells) {
  EXPECT_THROW(NoisePlane(1, CellHash::Integer, 0.0, {0.0, 5e5, 0.0, 5e5}), InvalidInput);
  EXPECT_THROW(NoisePlane(1, CellHash::Integer, 0.0, {0.0, 1e300, 0.0, 1.0}), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
