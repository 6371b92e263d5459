#include "forward/scattering/cell_density.h"

#include <cmath>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "forward/base/random.h"

namespace mezzotint {
namespace {

constexpr std::uint32_t columns = 21, rows = 13;  // no multiples of a block

std::vector<float> uneven() {
  std::vector<float> density(std::size_t{columns} * rows);
  const RandomStream random(3, RandomPurpose::Test);
  for (std::size_t k = 0; k < density.size(); ++k) {
    const auto u = random.uniform4(k);
    density[k] = u[0] < 0.2 ? 0.0F : static_cast<float>(std::pow(10.0, -2.0 * u[1]));
  }
  return density;
}

SurfacePoints drawn(const std::vector<float>& density, Placement placement, std::uint32_t bits) {
  const std::size_t count = std::size_t{1} << bits;
  SurfacePoints points(count);
  CellDensity(columns, rows, density).points(SampleStrata(bits, placement, 5, 0, 0), 0, count, points);
  return points;
}

std::size_t cell_of(const SurfacePoints& points, std::size_t k) {
  return static_cast<std::size_t>(points.cell_y[k]) * columns + static_cast<std::size_t>(points.cell_x[k]);
}

TEST(CellDensity, DrawsEachCellAsOftenAsItsDensitySays) {
  const std::vector<float> density = uneven();
  double total = 0.0;
  for (const float one : density) total += double{one};
  constexpr std::uint32_t bits = 16;
  const SurfacePoints random = drawn(density, Placement::Random, bits),
                      strata = drawn(density, Placement::Strata, bits);
  std::vector<double> times_random(density.size()), times_strata(density.size());
  for (std::size_t k = 0; k < (std::size_t{1} << bits); ++k) {
    ++times_random[cell_of(random, k)];
    ++times_strata[cell_of(strata, k)];
  }
  double chi_square = 0.0, cells = 0.0;
  for (std::size_t k = 0; k < density.size(); ++k) {
    const double expected = std::ldexp(double{density[k]} / total, bits);
    if (expected == 0.0) {
      EXPECT_EQ(times_random[k] + times_strata[k], 0.0);
      continue;
    }
    chi_square += std::pow(times_random[k] - expected, 2) / expected;
    cells += 1.0;
    // A cell's stretch of the line begins and ends within a stratum: at most one point more or less for each end.
    EXPECT_LE(std::abs(times_strata[k] - expected), 2.0 + 1e-3 * expected);
  }
  EXPECT_LT(chi_square, cells + 5.0 * std::sqrt(2.0 * cells));  // 5 standard deviations: 1 false alarm in 10^6
}

TEST(CellDensity, WeighsPointsSoThatMeansAreThoseOfTheArea) {
  const std::vector<float> density = uneven();
  constexpr std::uint32_t bits = 16;
  const auto count = std::ldexp(1.0, bits);
  for (const Placement placement : {Placement::Strata, Placement::Lattice, Placement::Random}) {
    const SurfacePoints points = drawn(density, placement, bits);
    double mean = 0.0, square = 0.0, expected = 0.0, covered = 0.0;
    const auto value = [](std::size_t cell) { return std::sin(static_cast<double>(cell)) + 2.0; };
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
      const double term = double{points.weight[k]} * value(cell_of(points, k)) / count;
      mean += term;
      square += term * term;
      EXPECT_TRUE(points.x[k] >= 0.0F && points.x[k] < 1.0F && points.y[k] >= 0.0F && points.y[k] < 1.0F);
    }
    for (std::size_t k = 0; k < density.size(); ++k) {
      if (density[k] == 0.0F) continue;
      expected += value(k) / static_cast<double>(density.size());
      covered += 1.0;
    }
    ASSERT_GT(covered, 100.0);
    EXPECT_NEAR(mean, expected, 5.0 * std::sqrt(square));  // 1 false alarm in 10^6 for random points, fewer for strata
    if (placement == Placement::Strata) {
      EXPECT_NEAR(mean, expected, 1e-2 * expected);
    }
  }
}

TEST(CellDensity, SpreadsPointsEvenlyWithinACell) {
  const SurfacePoints points = drawn(std::vector<float>(std::size_t{columns} * rows, 1.0F), Placement::Strata, 16);
  constexpr double count = 65536.0, per_quarter = count / 4.0;
  double quarters[4] = {};
  for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
    EXPECT_NEAR(points.weight[k], 1.0F, 1e-5F);
    ++quarters[(points.x[k] < 0.5F ? 0 : 1) + (points.y[k] < 0.5F ? 0 : 2)];
  }
  // χ² with 3 degrees of freedom: above 31 once in 10^6.
  double chi_square = 0.0;
  for (const double quarter : quarters) chi_square += std::pow(quarter - per_quarter, 2) / per_quarter;
  EXPECT_LT(chi_square, 31.0);
}

TEST(CellDensity, GivesTheSamePointsInPieces) {
  const std::vector<float> density = uneven();
  const CellDensity cells(columns, rows, density);
  const SampleStrata strata(12, Placement::Strata, 5, 1, 2);
  SurfacePoints all(4096), part(1000);
  cells.points(strata, 0, 4096, all);
  cells.points(strata, 2000, 1000, part);
  for (std::size_t k = 0; k < 1000; ++k) {
    EXPECT_EQ(part.cell_x[k], all.cell_x[2000 + k]);
    EXPECT_EQ(part.x[k], all.x[2000 + k]);
    EXPECT_EQ(part.weight[k], all.weight[2000 + k]);
  }
}

}  // namespace
}  // namespace mezzotint
