#include "forward/scattering/light_sweep.h"

#include <cmath>
#include <cstddef>
#include <numbers>

#include <gtest/gtest.h>

#include "forward/tracing/height_field_tracer.h"
#include "tests/forward/scattering/reliefs.h"

namespace mezzotint {
namespace {

Direction light_at(double theta_deg, double phi_deg) {
  return to_direction({Angle::from_degrees(theta_deg), Angle::from_degrees(phi_deg)});
}

TEST(LightSweep, FindsAPlainLitFromEverywhere) {
  const PeriodicTile tile(test::relief(16, 24, Continuation::Periodic, [](double, double) { return 3.0; }));
  for (const double theta : {0.0, 60.0, 89.0})
    for (const std::uint8_t cell : sweep_light(tile, light_at(theta, 30.0))) EXPECT_EQ(cell, 2);
}

// A wall of height 4 over one line: its shadow is 4·tanθ long.
TEST(LightSweep, CastsTheShadowOfAWallToTheFarSide) {
  constexpr double theta = 70.0;
  const double length = 4.0 * std::tan(theta * std::numbers::pi / 180.0);
  for (const bool along_x : {true, false}) {
    const PeriodicTile tile(test::relief(32, 40, Continuation::Periodic,
                                         [&](double c, double r) { return (along_x ? c : r) == 8.0 ? 4.0 : 0.0; }));
    for (const bool forward : {true, false}) {
      const double phi = (along_x ? 0.0 : 90.0) + (forward ? 0.0 : 180.0);  // the light; the shadow lies opposite
      const auto lit = sweep_light(tile, light_at(theta, phi));
      double dark = 0.0;
      const std::uint32_t around = along_x ? tile.columns() : tile.rows(), aside = 5;
      for (std::uint32_t k = 0; k < around; ++k) {
        const std::size_t cell =
            along_x ? std::size_t{aside} * tile.columns() + k : std::size_t{k} * tile.columns() + aside;
        dark += 1.0 - 0.5 * lit[cell];
        const bool behind = forward ? k < 8 || k > 8 + 20 : k >= 8 && k < 8 + 16;
        EXPECT_TRUE(lit[cell] != 0 || behind) << k << ' ' << phi;
      }
      EXPECT_NEAR(dark, length, 1.0) << phi;  // told at the grid's lines: half a cell at each end
    }
  }
}

TEST(LightSweep, AgreesWithTracedShadowsButAtTheirEdges) {
  const HeightField field = test::random_relief(128, 0.5);
  const PeriodicTile tile(field);
  const HeightFieldTracer tracer(tile);
  for (const double theta : {50.0, 70.0, 80.0}) {
    for (const double phi : {20.0, 110.0, 250.0}) {
      const Direction light = light_at(theta, phi);
      const auto lit = sweep_light(tile, light);
      const std::size_t cells = lit.size();
      RayBatch rays(cells);
      for (std::size_t k = 0; k < cells; ++k) {
        const auto column = static_cast<std::uint32_t>(k % 128), row = static_cast<std::uint32_t>(k / 128);
        rays.cell_x[k] = static_cast<std::int32_t>(column);
        rays.cell_y[k] = static_cast<std::int32_t>(row);
        rays.x[k] = 0.5F;
        rays.y[k] = 0.5F;
        // The middle lies on the diagonal, just above it the ray begins.
        rays.z[k] = 0.5F * (tile.height(column, row) + tile.height((column + 1) % 128, (row + 1) % 128)) + 1e-4F;
        rays.dx[k] = static_cast<float>(light.x());
        rays.dy[k] = static_cast<float>(light.y());
        rays.dz[k] = static_cast<float>(light.z());
        rays.side[k] = Side::Outside;
        rays.left[k] = no_half;
      }
      HitBatch hits(cells);
      tracer.closest_hits(rays, cells, hits);
      double wrong = 0.0, dark = 0.0;
      for (std::size_t k = 0; k < cells; ++k) {
        const bool is_lit = hits.end[k] == RayEnd::Above;
        dark += is_lit ? 0.0 : 1.0;
        wrong += (lit[k] == 2 && !is_lit) || (lit[k] == 0 && is_lit) ? 1.0 : 0.0;
      }
      ASSERT_GT(dark, 0.005 * static_cast<double>(cells));
      // Cells at the edge of a shadow: measured 0.1 to 1.2 %.
      EXPECT_LT(wrong, 0.02 * static_cast<double>(cells)) << theta << ' ' << phi << " dark " << dark;
    }
  }
}

}  // namespace
}  // namespace mezzotint
