#include "forward/scattering/slope_splat.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "forward/pattern/pattern.h"
#include "forward/scattering/path_tracing.h"

namespace mezzotint {
namespace {

constexpr DirectionGrid grid{32, 32};

double albedo(const DirectionMap& map) {
  const auto areas = projected_solid_angles(grid);
  double sum = 0.0;
  for (std::size_t bin = 0; bin < map.size(); ++bin) sum += map[bin] * areas[bin];
  return sum;
}

TEST(SlopeSplat, OfAFlatMirrorIsOneBinWithAllTheLight) {
  const HeightField flat({16, 16, 1.0_um, 1.0_um}, Continuation::Mirrored);
  const DirectionAngles light{40.0_deg, 15.0_deg};
  const DirectionMap map = slope_reflection_map(flat, Mirror{}, light, grid);
  const Direction mirrored = to_direction({40.0_deg, 195.0_deg});
  EXPECT_NEAR(albedo(map), 1.0, 1e-12);
  EXPECT_NEAR(map[grid.bin_of(mirrored.x(), mirrored.y())] *
                  projected_solid_angles(grid)[grid.bin_of(mirrored.x(), mirrored.y())],
              1.0, 1e-12);
}

TEST(SlopeSplat, OfATiltedFacetTurnsTheLightByTwiceTheTilt) {
  HeightField tilted({16, 16, 1.0_um, 1.0_um}, Continuation::Mirrored);
  const double tilt = 12.0 * std::numbers::pi / 180.0;
  for (std::size_t row = 0; row < 16; ++row) {
    for (std::size_t column = 0; column < 16; ++column) {
      tilted.at(column, row) = static_cast<float>(static_cast<double>(column) * std::tan(tilt));
    }
  }
  const DirectionMap map = slope_reflection_map(tilted, Mirror{}, {0.0_deg, 0.0_deg}, grid);
  EXPECT_GT(map[grid.bin_of(-std::sin(2.0 * tilt), 0.0)], 0.0);  // the surface rises along +x, so it looks to −x
  EXPECT_NEAR(albedo(map), 1.0,
              1e-6);  // a tilted facet catches cos(tilt)·(1/cos(tilt)) of the light; heights are floats
}

TEST(SlopeSplat, AgreesWithTracedPathsOnGentleRelief) {
  const HeightField relief = synthesize(
      Noise{.scale = 40.0_um, .stretch = 2.0, .direction = 30.0_deg, .height = 6.0_um}, {256, 256, 2.0_um, 2.0_um});
  for (const Material& material : {Material{Mirror{}}, Material{Dielectric{1.5}}}) {
    const DirectionAngles light{30.0_deg, 70.0_deg};
    const Bsdf traced =
        trace_bsdf(relief, {.incidence = light, .grid = grid, .material = material, .samples = 1U << 19});
    const MapDifference difference =
        relative_l2(grid, traced.reflection, slope_reflection_map(relief, material, light, grid));
    // RMS slopes of 0.1 and 0.05: shadowing and second bounces are below 1e-3 of the light; what is left is the
    // noise of the paths, and the edge of the patch, whose facets the mirrored copies shade differently.
    EXPECT_LT(difference.corrected.value, 0.02 + 3.0 * difference.corrected.standard_error);
  }
}

TEST(SlopeSplat, RefusesLightFromBelow) {
  const HeightField flat({4, 4, 1.0_um, 1.0_um}, Continuation::Mirrored);
  EXPECT_THROW((void)slope_reflection_map(flat, Mirror{}, {90.0_deg, 0.0_deg}, grid), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
