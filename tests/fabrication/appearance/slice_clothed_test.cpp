#include <numbers>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "fabrication/appearance/slice_clothed.h"
#include "fabrication/appearance/solid_relief.h"
#include "forward/base/error.h"
#include "tests/fabrication/appearance/shapes.h"

namespace mezzotint {
namespace {

PrinterProfile small_printer() {
  PrinterProfile printer;
  printer.pixels_x = 120;
  printer.pixels_y = 90;
  return printer;
}

struct Sliced {
  SliceSummary summary;
  std::vector<std::vector<std::uint8_t>> layers;
};
Sliced sliced(const PartMesh& mesh, const SurfaceRelief& relief, const SliceOptions& options = {}) {
  Sliced result;
  result.summary = slice_clothed(mesh, smooth_surface(mesh, 40.0_deg), relief, small_printer(), options, {},
                                 [&](SlicedLayer&& layer) { result.layers.push_back(to_pixels(layer.picture)); });
  return result;
}

SurfaceRelief constant(double um) {
  return {[um]() -> ReliefProbe { return [um](const SurfacePoint&) { return um; }; }, Length{}, Length::from_um(um)};
}

TEST(SliceClothed, GrowsACylinderByItsRelief) {
  const double r = 0.25, h = 0.3, d = 0.015;
  const Sliced plain = sliced(cylinder(r, h, 128, 3), constant(0.0)),
               grown = sliced(cylinder(r, h, 128, 3), constant(15.0));
  const double area = std::numbers::pi * r * r, wide = std::numbers::pi * (r + d) * (r + d);
  EXPECT_NEAR(plain.summary.volume_mm3, area * h, 1e-3 * area * h);
  EXPECT_NEAR(grown.summary.volume_mm3, wide * (h + d), 2e-3 * wide * h);
  EXPECT_EQ(grown.summary.total.open_rows, 0U);
  EXPECT_EQ(grown.layers.size(), 18U);  // 315 µm by 18 µm
}

TEST(SliceClothed, HasTheSameBitsWithAnyNumberOfThreads) {
  std::vector<Sliced> runs;
  for (const std::size_t threads : {1U, 3U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    runs.push_back(sliced(sphere(0.25, 3), solid_relief(Noise{.scale = 60.0_um})));
  }
  EXPECT_EQ(runs[0].layers, runs[1].layers);
  EXPECT_GT(runs[0].summary.total.lit_pixels, 1000U);
}

TEST(SliceClothed, RefusesAReliefThatReachesOutOfTheField) {
  const PrinterProfile printer = small_printer();
  const double width = printer.pixel_pitch.mm() * 118.0;
  EXPECT_NO_THROW((void)sliced(box(width, 0.2, 0.1), constant(7.0)));
  EXPECT_THROW((void)sliced(box(width, 0.2, 0.1), constant(16.0)), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
