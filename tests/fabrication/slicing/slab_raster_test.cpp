#include "fabrication/slicing/slab_raster.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "tests/fabrication/slicing/shapes.h"

namespace mezzotint {
namespace {

using test::Outline;

constexpr std::size_t columns = 70, rows = 50;
constexpr CoverageOptions midplane = {CoverageMode::Midplane, 0};
constexpr CoverageOptions by_volume = {CoverageMode::Volume, 0};
// Coverage adds up in float along a row.
constexpr double rounding = 4e-5;

struct Layer {
  std::vector<double> coverage = std::vector<double>(columns * rows, 0.0);
  std::size_t open_rows = 0;

  [[nodiscard]] double sum() const {
    double total = 0.0;
    for (const double c : coverage) total += c;
    return total;
  }
  [[nodiscard]] double moment_x() const {
    double total = 0.0;
    for (std::size_t i = 0; i < coverage.size(); ++i) total += coverage[i] * (static_cast<double>(i % columns) + 0.5);
    return total;
  }
};

Layer layer_of(const std::vector<RasterTriangle>& triangles, std::size_t layer, const CoverageOptions& options) {
  SlabRaster raster(columns, rows, options);
  raster.begin(layer);
  raster.add(triangles);
  Layer result;
  result.open_rows = raster.finish([&](std::size_t row, std::span<const CoverageRun> runs) {
    for (const CoverageRun& run : runs) {
      std::fill(result.coverage.begin() + static_cast<long>(row * columns + run.begin),
                result.coverage.begin() + static_cast<long>(row * columns + run.end), double{run.coverage});
    }
  });
  return result;
}

double area_in_pixel(const Outline& outline, std::size_t column, std::size_t row) {
  const auto x = static_cast<double>(column), y = static_cast<double>(row);
  return test::area(test::cut_by(
      test::cut_by(test::cut_by(test::cut_by(outline, 0, x, 1.0), 0, x + 1.0, -1.0), 1, y, 1.0), 1, y + 1.0, -1.0));
}

void expect_exact(const Outline& outline, const CoverageOptions& options) {
  const Layer layer = layer_of(test::as_triangles(test::prism(outline, -3.0, 7.0)), 2, options);
  EXPECT_EQ(layer.open_rows, 0U);
  for (std::size_t i = 0; i < columns * rows; ++i) {
    ASSERT_NEAR(layer.coverage[i], area_in_pixel(outline, i % columns, i / columns), rounding)
        << "pixel " << i % columns << ", " << i / columns;
  }
}

Outline random_triangle(std::mt19937& random) {
  std::uniform_real_distribution<double> x(0.0, columns), y(0.0, rows);
  Outline triangle = {{x(random), y(random)}, {x(random), y(random)}, {x(random), y(random)}};
  if (test::area(triangle) < 0.0) std::swap(triangle[0], triangle[1]);
  return triangle;
}

TEST(SlabRaster, CoversRandomTrianglesExactly) {
  std::mt19937 random(3);
  for (int i = 0; i < 40; ++i) {
    const Outline triangle = random_triangle(random);
    expect_exact(triangle, midplane);
    expect_exact(triangle, by_volume);
  }
}

TEST(SlabRaster, CoversDiscsAndGearsExactly) {
  for (const CoverageOptions& options : {midplane, by_volume}) {
    expect_exact(test::disc(33.21, 24.87, 22.4, 720, 0.1), options);
    expect_exact(test::disc(12.3, 9.1, 0.4, 90), options);
    expect_exact(test::gear(35.1, 25.2, 18.0, 23.0, 17, 0.05), options);
  }
}

TEST(SlabRaster, KeepsCornersOnPixelCornersApart) {
  expect_exact({{10.0, 10.0}, {20.0, 10.0}, {20.0, 30.0}, {10.0, 30.0}}, midplane);
  expect_exact({{10.0, 10.0}, {20.0, 10.0}, {20.0, 30.0}, {10.0, 30.0}}, by_volume);
  expect_exact({{0.0, 0.0}, {70.0, 0.0}, {70.0, 50.0}, {0.0, 50.0}}, by_volume);
}

TEST(SlabRaster, SeesAShiftOfAHundredthOfAPixel) {
  const PartMesh wheel = test::prism(test::gear(35.0, 25.0, 17.0, 22.0, 13), 0.0, 3.0);
  const double here = layer_of(test::as_triangles(wheel), 1, midplane).moment_x();
  const Layer there = layer_of(test::as_triangles(wheel, {0.01, 0.0, 0.0}), 1, midplane);
  // The centroid moves by the shift; where in its pixel an area lies is not kept, which leaves some 1e-4.
  EXPECT_NEAR((there.moment_x() - here) / there.sum(), 0.01, 2e-4);
}

TEST(SlabRaster, SumsToTheVolumeOfEverySlab) {
  const PartMesh ball = test::sphere({34.3, 25.4, 10.7}, 9.3, 40, 60);
  const auto triangles = test::as_triangles(ball);
  double total = 0.0;
  for (std::size_t layer = 0; layer < 22; ++layer) total += layer_of(triangles, layer, by_volume).sum();
  EXPECT_NEAR(total, test::volume(ball), 1e-5 * test::volume(ball));
}

// Volume and plane are two sets of formulas; the mean of many planes is the volume.
TEST(SlabRaster, AVolumeIsTheMeanOfItsPlanes) {
  PartMesh body = test::sphere({30.0, 22.0, 1.4}, 1.9, 9, 11);
  for (auto& v : body.vertices_mm) v = {30.0 + 9.0 * (v[0] - 30.0) + v[2], 22.0 + 7.0 * (v[1] - 22.0), v[2]};
  const Layer volume = layer_of(test::as_triangles(body), 1, by_volume);
  Layer mean;
  constexpr int planes = 400;
  for (int i = 0; i < planes; ++i) {
    const Layer plane = layer_of(test::as_triangles(body, {0.0, 0.0, 0.5 - (i + 0.5) / planes}), 1, midplane);
    for (std::size_t p = 0; p < mean.coverage.size(); ++p) mean.coverage[p] += plane.coverage[p] / planes;
  }
  for (std::size_t p = 0; p < mean.coverage.size(); ++p) {
    // The midpoint rule misses a kink by up to 1/(8·planes) of it.
    ASSERT_NEAR(volume.coverage[p], mean.coverage[p], 1e-3) << "pixel " << p % columns << ", " << p / columns;
  }
  EXPECT_NEAR(volume.sum(), mean.sum(), 1e-4 * mean.sum());
}

TEST(SlabRaster, GivesAFlatFaceInsideALayerItsHeight) {
  const auto triangles = test::as_triangles(test::box({5.0, 5.0, 0.0}, {15.0, 15.0, 2.37}));
  EXPECT_NEAR(layer_of(triangles, 1, by_volume).coverage[8 * columns + 8], 1.0, rounding);
  EXPECT_NEAR(layer_of(triangles, 2, by_volume).coverage[8 * columns + 8], 0.37, rounding);
  EXPECT_EQ(layer_of(triangles, 2, midplane).sum(), 0.0);
  EXPECT_EQ(layer_of(triangles, 3, by_volume).sum(), 0.0);
}

TEST(SlabRaster, CutsOffWhatLiesOutsideOfThePicture) {
  const Outline wide = test::disc(35.0, 25.0, 60.0, 100);
  expect_exact(wide, midplane);
  expect_exact(wide, by_volume);
  const Outline corner = test::disc(1.0, 49.0, 13.3, 77);
  expect_exact(corner, midplane);
  expect_exact(corner, by_volume);
  const Outline right = test::disc(69.0, 2.0, 13.3, 77);
  expect_exact(right, midplane);
  expect_exact(right, by_volume);
}

TEST(SlabRaster, TakesOverlappingBodiesAsOne) {
  auto triangles = test::as_triangles(test::box({5.0, 5.0, 0.0}, {30.0, 30.0, 3.0}));
  const auto other = test::as_triangles(test::box({20.0, 10.0, 0.0}, {40.5, 20.0, 3.0}));
  triangles.insert(triangles.end(), other.begin(), other.end());
  for (const CoverageOptions& options : {midplane, by_volume}) {
    EXPECT_NEAR(layer_of(triangles, 1, options).sum(), 25.0 * 25.0 + 10.5 * 10.0, 1e-3);
  }
}

TEST(SlabRaster, CountsTheRowsOfAHole) {
  auto triangles = test::as_triangles(test::box({5.0, 5.0, 0.0}, {30.0, 30.0, 3.0}));
  for (const std::size_t wall : {5U, 4U}) {  // that at x = 30
    triangles[wall] = triangles.back();
    triangles.pop_back();
  }
  EXPECT_EQ(layer_of(triangles, 1, midplane).open_rows, 25U);
  EXPECT_EQ(layer_of(triangles, 1, by_volume).open_rows, 25U);
}

TEST(SlabRaster, IsEmptyAfterEachLayer) {
  SlabRaster raster(columns, rows);
  raster.begin(1);
  raster.add(test::as_triangles(test::sphere({30.0, 20.0, 2.0}, 2.0, 20, 30)));
  EXPECT_EQ(raster.finish([](std::size_t, std::span<const CoverageRun>) {}), 0U);
  std::size_t taken = 0;
  EXPECT_EQ(raster.finish([&](std::size_t, std::span<const CoverageRun>) { ++taken; }), 0U);
  EXPECT_EQ(taken, 0U);
}

TEST(SlabRaster, SamplesApproachTheExactArea) {
  const Outline outline = test::disc(33.21, 24.87, 22.4, 720, 0.1);
  const auto triangles = test::as_triangles(test::prism(outline, 0.0, 3.0));
  double before = 1.0;
  for (const int samples : {1, 2, 4, 8, 16}) {
    const Layer layer = layer_of(triangles, 1, {CoverageMode::Midplane, samples});
    EXPECT_EQ(layer.open_rows, 0U);
    double squares = 0.0;
    for (std::size_t i = 0; i < columns * rows; ++i) {
      const double exact = area_in_pixel(outline, i % columns, i / columns);
      squares += (layer.coverage[i] - exact) * (layer.coverage[i] - exact);
      // Every sample is there or not: N² + 1 levels.
      const double level = layer.coverage[i] * samples * samples;
      ASSERT_NEAR(level, std::round(level), 1e-2);
    }
    EXPECT_LT(squares, samples == 1 ? 1e9 : 0.4 * before);
    before = squares;
  }
}

TEST(SlabRaster, CountsSamplesOneByOne) {
  const Outline triangle = {{3.2, 2.1}, {61.7, 14.9}, {20.3, 44.4}};
  const auto triangles = test::as_triangles(test::prism(triangle, 0.0, 3.0));
  constexpr int samples = 3;
  const Layer layer = layer_of(triangles, 1, {CoverageMode::Midplane, samples});
  const auto inside = [&](double x, double y) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto &a = triangle[i], &b = triangle[(i + 1) % 3];
      if ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]) < 0.0) return false;
    }
    return true;
  };
  for (std::size_t i = 0; i < columns * rows; ++i) {
    int hits = 0;
    for (int s = 0; s < samples * samples; ++s) {
      hits += inside(static_cast<double>(i % columns) + (s % samples + 0.5) / samples,
                     static_cast<double>(i / columns) + (s / samples + 0.5) / samples);
    }
    ASSERT_NEAR(layer.coverage[i] * samples * samples, hits, 1e-3);
  }
}

TEST(SlabRaster, RefusesAPictureWithoutPixels) {
  EXPECT_THROW(SlabRaster(0, 5), InvalidInput);
  EXPECT_THROW(SlabRaster(5, 65536), InvalidInput);
  EXPECT_THROW(SlabRaster(5, 5, {CoverageMode::Midplane, -1}), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
