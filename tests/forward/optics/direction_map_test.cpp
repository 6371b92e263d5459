#include "forward/optics/direction_map.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>

#include "forward/base/error.h"

namespace mezzotint {
namespace {

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

constexpr DirectionGrid odd_grids[] = {{1, 1},   {2, 2},   {3, 3},   {1, 5},    {7, 2},
                                       {10, 10}, {63, 17}, {64, 64}, {512, 512}};

TEST(DirectionGrid, PutsADirectionWhereTheSlidesSay) {
  const DirectionGrid grid{64, 32};
  EXPECT_EQ(grid.bin_of(0.0, 0.0), 16U * 64U + 32U);  // (0, 0) is a corner of four bins
  EXPECT_EQ(grid.bin_of(-1.0, 0.0), 16U * 64U);
  EXPECT_EQ(grid.bin_of(1.0, 0.0), 16U * 64U + 63U);  // x = +1 belongs to the last bin
  EXPECT_EQ(grid.bin_of(0.0, 1.0), 31U * 64U + 32U);
  EXPECT_EQ(grid.bin_of(0.0, -1.0), 32U);                    // row 0 is y = −1
  EXPECT_EQ(grid.bin_of(1.0 / 32.0, 0.0), 16U * 64U + 33U);  // an edge belongs to the bin beyond
  EXPECT_EQ(grid.bin_of(-1.0 - 1e-16, -1.0), 0U);            // a rounding beyond the rim
}

TEST(ProjectedSolidAngles, SumToPi) {
  // 1e-12: the rounding of up to 262144 terms.
  for (const DirectionGrid& grid : odd_grids) {
    EXPECT_NEAR(sum(projected_solid_angles(grid)), std::numbers::pi, 1e-12) << grid.width << " x " << grid.height;
  }
}

TEST(ProjectedSolidAngles, HaveTheirClosedForms) {
  for (const double area : projected_solid_angles({2, 2})) EXPECT_NEAR(area, std::numbers::pi / 4.0, 1e-15);
  const std::vector<double> areas = projected_solid_angles({4, 4});
  // Sector of 30° less two triangles.
  const double corner = std::numbers::pi / 12.0 - (std::sqrt(3.0) - 1.0) / 4.0;
  for (const std::size_t k : {0U, 3U, 12U, 15U}) EXPECT_NEAR(areas[k], corner, 1e-15);
  EXPECT_EQ(areas[5], 0.25);
}

TEST(ProjectedSolidAngles, AgreeWithColumnsOfTheDisc) {
  for (const DirectionGrid grid : {DirectionGrid{16, 12}, DirectionGrid{5, 9}}) {
    const std::vector<double> areas = projected_solid_angles(grid);
    const double width = 2.0 / static_cast<double>(grid.width), height = 2.0 / static_cast<double>(grid.height);
    for (std::size_t bin = 0; bin < areas.size(); ++bin) {
      const double x0 = -1.0 + width * static_cast<double>(bin % grid.width);
      const double y0 = -1.0 + height * static_cast<double>(bin / grid.width);
      constexpr int columns = 4000;
      double expected = 0.0;
      for (int i = 0; i < columns; ++i) {
        const double x = x0 + width * (i + 0.5) / columns;
        const double half_chord = std::sqrt(std::max(0.0, 1.0 - x * x));
        expected += std::max(0.0, std::min(half_chord, y0 + height) - std::max(-half_chord, y0)) * width / columns;
      }
      // Midpoints beside the vertical tangent: (width / columns)^1.5 is 1e-6.
      EXPECT_NEAR(areas[bin], expected, 2e-6) << bin;
    }
  }
}

TEST(ProjectedSolidAngles, KnowTheRimAt64) {
  const DirectionGrid grid;
  const std::vector<double> areas = projected_solid_angles(grid);
  std::size_t touched = 0, rim = 0, centre_outside = 0;
  for (std::size_t bin = 0; bin < areas.size(); ++bin) {
    touched += areas[bin] > 0.0;
    if (areas[bin] <= 0.0 || areas[bin] > 4.0 / 4096.0 * (1.0 - 1e-9)) continue;
    ++rim;
    const double x = (static_cast<double>(bin % 64) - 31.5) / 32.0, y = (static_cast<double>(bin / 64) - 31.5) / 32.0;
    centre_outside += x * x + y * y > 1.0;
  }
  EXPECT_EQ(touched, 3332U);
  EXPECT_EQ(rim, 252U);
  EXPECT_EQ(centre_outside, 104U);
}

TEST(ProjectedSolidAngles, ArePositiveWhereWholeNumbersSayThatThePixelMeetsTheDisc) {
  const DirectionGrid grid{600, 401};
  const std::vector<double> areas = projected_solid_angles(grid);
  const auto w = static_cast<std::int64_t>(grid.width), h = static_cast<std::int64_t>(grid.height);
  // Distance from 0 of the nearest point of a pixel's side, in units of 1/bins.
  const auto nearest = [](std::int64_t index, std::int64_t bins) {
    const std::int64_t from = 2 * index - bins, to = from + 2;
    return from >= 0 ? from : to <= 0 ? -to : 0;
  };
  for (std::int64_t row = 0; row < h; ++row) {
    for (std::int64_t column = 0; column < w; ++column) {
      const std::int64_t x = nearest(column, w) * h, y = nearest(row, h) * w;
      ASSERT_EQ(areas[static_cast<std::size_t>(row * w + column)] > 0.0, x * x + y * y < w * w * h * h);
    }
  }
}

TEST(ProjectedSolidAngles, RefuseAGridThatIsEmptyOrTooLargeBeforeTheyAllocate) {
  EXPECT_THROW((void)projected_solid_angles({0, 64}), InvalidInput);
  EXPECT_THROW((void)projected_solid_angles({64, 4097}), InvalidInput);
  EXPECT_THROW((void)projected_solid_angles({1000000000, 1000000000}), InvalidInput);
}

TEST(AverageOverBins, KeepsAConstantInEveryBinThatTheDiscTouches) {
  for (const DirectionGrid& grid : odd_grids) {
    if (grid.size() > 10000) continue;
    const std::vector<double> areas = projected_solid_angles(grid);
    const DirectionMap map = average_over_bins(
        grid, [](const Direction&) { return 7.0; }, 2);
    for (std::size_t k = 0; k < map.size(); ++k) EXPECT_NEAR(map[k], areas[k] > 0.0 ? 7.0 : 0.0, 1e-14);  // rounding
  }
}

TEST(AverageOverBins, GivesUnitVectorsOfTheUpperHemisphereInsideOfTheBin) {
  const DirectionGrid grid{9, 6};
  std::vector<int> seen(grid.size(), 0);
  (void)average_over_bins(
      grid,
      [&](const Direction& direction) {
        EXPECT_NEAR(direction.norm(), 1.0, 1e-15);
        EXPECT_GE(direction.z(), 0.0);
        ++seen[grid.bin_of(direction.x(), direction.y())];
        return 0.0;
      },
      4);
  for (std::size_t k = 0; k < seen.size(); ++k) EXPECT_EQ(seen[k] >= 16, projected_solid_angles(grid)[k] > 0.0) << k;
}

TEST(AverageOverBins, IntegratesToTheClosedFormAtSecondOrder) {
  const DirectionGrid grid{16, 16};
  const std::vector<double> areas = projected_solid_angles(grid);
  const auto error_with = [&](std::size_t samples) {
    const DirectionMap map = average_over_bins(
        grid, [](const Direction& direction) { return direction.z(); }, samples);
    double integral = 0.0;
    for (std::size_t k = 0; k < map.size(); ++k) integral += map[k] * areas[k];
    return integral - 2.0 * std::numbers::pi / 3.0;  // ∫ √(1 − r²) dA
  };
  // Midpoints: (1/64)²/24 of the second derivatives over the disc, which are large toward the rim.
  EXPECT_NEAR(error_with(8), 0.0, 5e-4);
  // Second order, in spite of the root at the rim; higher terms are a percent of it.
  EXPECT_NEAR(error_with(8) / error_with(32), 16.0, 1.0);
}

TEST(AverageOverBins, FindsTheCentroidOfABinOnTheRim) {
  const DirectionMap map = average_over_bins(
      {4, 4}, [](const Direction& direction) { return direction.x(); }, 64);
  const double area = std::numbers::pi / 12.0 - (std::sqrt(3.0) - 1.0) / 4.0, top = std::sqrt(0.75);
  const double moment = 0.5 * (0.75 * (top - 0.5) - (top * top * top - 0.125) / 3.0);  // ∫ ½(1 − y² − ¼) dy
  EXPECT_NEAR(map[15], moment / area, 1e-5);  // midpoints: 1/64² of a twentieth of the bin
}

}  // namespace
}  // namespace mezzotint
