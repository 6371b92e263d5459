#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "fabrication/appearance/displaced_surface.h"
#include "fabrication/appearance/solid_relief.h"
#include "fabrication/slicing/slab_raster.h"
#include "forward/base/error.h"
#include "forward/pattern/sparse_noise.h"
#include "tests/fabrication/appearance/shapes.h"

namespace mezzotint {
namespace {

constexpr double pixel_mm = 0.01, layer_mm = 0.02;

RasterFrame frame_at(double x_pixels, double y_pixels, double z_layers = 0.0) {
  return {1.0 / pixel_mm, 0.0, 1.0 / layer_mm, x_pixels, y_pixels, z_layers};
}

SurfaceRelief constant(double um) {
  return {[um]() -> ReliefProbe { return [um](const SurfacePoint&) { return um; }; },
          Length::from_um(std::min(um, 0.0)), Length::from_um(std::max(um, 0.0))};
}

DisplacedSurface displaced(const PartMesh& mesh, const SurfaceRelief& relief, const RasterFrame& frame,
                           double edge_mm = 0.0075) {
  return {smooth_surface(mesh, 40.0_deg), relief, frame, Length::from_mm(edge_mm)};
}

// Enclosed volume, and the sum of all area vectors, which vanishes for what is closed; mm.
struct Whole {
  double volume = 0.0;
  std::array<double, 3> area{};
};
Whole whole_of(const DisplacedSurface& surface) {
  Whole whole;
  surface.for_all_triangles([&](const RasterTriangle& t) {
    const auto at = [&](std::size_t k) {
      return std::array<double, 3>{t.at(k).x * pixel_mm, t.at(k).y * pixel_mm, t.at(k).z * layer_mm};
    };
    const auto a = at(0), b = at(1), c = at(2);
    std::array<double, 3> n{};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      n.at(i) = ((b.at(j) - a.at(j)) * (c.at(k) - a.at(k)) - (b.at(k) - a.at(k)) * (c.at(j) - a.at(j))) / 2.0;
      whole.area.at(i) += n.at(i);
    }
    whole.volume += n[2] * (a[2] + b[2] + c[2]) / 3.0;
  });
  return whole;
}

using Layer = std::vector<double>;  // coverage, row by row

std::vector<Layer> sliced(const DisplacedSurface& surface, std::size_t columns, std::size_t rows, std::size_t layers,
                          std::size_t band) {
  std::vector<Layer> result(layers, Layer(columns * rows, 0.0));
  for (std::size_t first = 0; first < layers; first += band) {
    std::vector<SlabRaster> rasters;
    for (std::size_t i = 0; i < band; ++i) {
      rasters.emplace_back(columns, rows);
      rasters.back().begin(first + i);
    }
    surface.for_each_triangle(first, band, [&](std::size_t layer, std::span<const RasterTriangle> triangles) {
      rasters[layer - first].add(triangles);
    });
    for (std::size_t i = 0; i < band && first + i < layers; ++i) {
      Layer& into = result[first + i];
      const std::size_t open = rasters[i].finish([&](std::size_t row, std::span<const CoverageRun> runs) {
        for (const CoverageRun& run : runs)
          for (std::uint32_t c = run.begin; c < run.end; ++c) into[row * columns + c] = double(run.coverage);
      });
      EXPECT_EQ(open, 0U) << "layer " << first + i;
    }
  }
  return result;
}

TEST(DisplacedSurface, MovesABoxOutwardOnAllSidesButThePlatforms) {
  const double d = 0.016;
  const Whole whole = whole_of(displaced(box(0.5, 0.4, 0.3), constant(16.0), frame_at(0, 0)));
  // The rim of the bottom stays on the platform; from there the walls lean out within half a pixel.
  const double straight = (0.5 + 2 * d) * (0.4 + 2 * d) * (0.3 + d);
  EXPECT_LT(whole.volume, straight);
  EXPECT_GT(whole.volume, straight - 2 * (0.5 + 0.4 + 4 * d) * d * 0.0075);
  for (const double area : whole.area) EXPECT_NEAR(area, 0.0, 1e-13);
}

TEST(DisplacedSurface, MovesASphereToALargerOne) {
  const double r = 0.5, d = 0.016;
  const auto volume = [](double radius) { return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius; };
  // What the mesh itself lacks of a sphere, scaled with it, is left out of the comparison.
  const double own = whole_of(displaced(sphere(r, 5), constant(0.0), frame_at(0, 0))).volume;
  const double moved = whole_of(displaced(sphere(r, 5), constant(1e3 * d), frame_at(0, 0))).volume;
  EXPECT_NEAR(moved / own, volume(r + d) / volume(r), 2e-4);
  EXPECT_NEAR(moved, volume(r + d), 2e-3 * volume(r + d));
}

TEST(DisplacedSurface, IsClosedUnderNoiseOnEveryKindOfMesh) {
  const SurfaceRelief noise = solid_relief(Noise{.scale = 60.0_um});
  PartMesh notched = box(0.4, 0.4, 0.3);
  // A pyramid cut into the lid: concave creases.
  notched.vertices_mm.push_back({0.2, 0.2, 0.15});
  notched.triangles[2] = {4, 5, 8};
  notched.triangles[3] = {5, 7, 8};
  notched.triangles.push_back({7, 6, 8});
  notched.triangles.push_back({6, 4, 8});
  for (const PartMesh& mesh : {box(0.3, 0.35, 0.25), sphere(0.25, 2), cylinder(0.2, 0.3, 24, 2), notched}) {
    const Whole whole = whole_of(displaced(mesh, noise, frame_at(0, 0)));
    for (const double area : whole.area) EXPECT_NEAR(area, 0.0, 1e-13);
    const double before = whole_of(displaced(mesh, constant(0.0), frame_at(0, 0))).volume;
    EXPECT_GT(whole.volume, before);
  }
}

// The lid of a plate against the same pattern as a height field: a vertical column of coverage is the height.
TEST(DisplacedSurface, PutsAPlateUnderThePatternsOwnHeights) {
  const Noise noise{.scale = 80.0_um, .height = 16.0_um, .seed = 4};
  PartMesh plate = box(0.4, 0.3, 0.2);
  constexpr std::size_t columns = 46, rows = 36, layers = 12;
  const DisplacedSurface surface = displaced(plate, solid_relief(noise), frame_at(3.0, 3.0), 0.004);
  const std::vector<Layer> volume = sliced(surface, columns, rows, layers, 5);
  // Solid noise on z = 0.2 mm, point by point: 6 × 6 points a pixel.
  const NoiseLattice lattice(noise.seed, noise.hash);
  double most = 0.0;
  for (std::size_t row = 6; row < 30; ++row) {
    for (std::size_t column = 6; column < 40; ++column) {
      double expected = 0.0, found = 0.0;
      for (int i = 0; i < 36; ++i) {
        const double x = (double(column) - 3.0 + (i % 6 + 0.5) / 6) * 1e3 * pixel_mm;
        const double y = (double(row) - 3.0 + (i / 6 + 0.5) / 6) * 1e3 * pixel_mm;
        const double n = sparse_noise(lattice, x / 80.0, y / 80.0, 200.0 / 80.0);
        expected += 16.0 * std::clamp(0.5 + n, 0.0, 1.0) / 36.0;
      }
      for (const Layer& layer : volume) found += 1e3 * layer_mm * layer[row * columns + column];
      most = std::max(most, std::abs(found - 200.0 - expected));
    }
  }
  // µm; the micro-triangles' chords cut off as much of the noise's waves.
  EXPECT_LT(most, 0.06);
}

TEST(DisplacedSurface, BandsOfAnyHeightGiveTheSameLayers) {
  const DisplacedSurface surface = displaced(sphere(0.2, 3), solid_relief(Noise{.scale = 60.0_um}), frame_at(25, 25));
  const auto one = sliced(surface, 50, 50, 22, 1), many = sliced(surface, 50, 50, 22, 7);
  double most = 0.0, sum = 0.0;
  for (std::size_t k = 0; k < one.size(); ++k) {
    for (std::size_t i = 0; i < one[k].size(); ++i) {
      most = std::max(most, std::abs(one[k][i] - many[k][i]));
      sum += one[k][i];
    }
  }
  EXPECT_EQ(most, 0.0);
  const double below = 0.01 * sum * pixel_mm * pixel_mm * layer_mm;  // some of it is pushed under the platform
  EXPECT_NEAR(sum * pixel_mm * pixel_mm * layer_mm, whole_of(surface).volume, below);
}

TEST(DisplacedSurface, RefusesWhatMakesNoSense) {
  EXPECT_THROW((void)displaced(box(1, 1, 1), {}, frame_at(0, 0)), InvalidInput);
  EXPECT_THROW((void)displaced(box(1, 1, 1), constant(1.0), frame_at(0, 0), 0.0), InvalidInput);
  EXPECT_THROW((void)smooth_surface(box(1, 1, 1), 0.0_deg), InvalidInput);
  EXPECT_THROW((void)solid_relief(Ridges{}), InvalidInput);
  EXPECT_THROW((void)solid_relief(Noise{.stretch = 2.0}), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
