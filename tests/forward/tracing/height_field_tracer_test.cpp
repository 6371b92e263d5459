#include "forward/tracing/height_field_tracer.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "forward/tracing/beam_front.h"
#include "forward/tracing/relief_scene.h"
#include "tests/forward/scattering/reliefs.h"
#include "tests/forward/tracing/tracers.h"

namespace mezzotint {
namespace {

struct Case {
  const char* name;
  HeightField field;
};

// A random relief on a tile that is no power of two, cells that are not square, a saw of near-vertical steps, and the
// smallest tile there is.
std::vector<Case> reliefs() {
  std::vector<Case> cases;
  cases.push_back({"random", test::random_relief(128, 0.3)});
  cases.push_back({"rough", test::random_relief(64, 1.0)});
  cases.push_back({"odd", test::relief(
                              37, 53, Continuation::Periodic,
                              [](double c, double r) {
                                return 2.0 * std::sin(c * 0.6793) * std::cos(r * 0.4742) + 0.3 * std::sin(7.0 * c + r);
                              },
                              0.7)});
  cases.push_back({"steps", test::relief(40, 24, Continuation::Periodic, [](double c, double r) {
                     return std::fmod(c, 8.0) < 4.0 ? 5.0 + 0.01 * r : 0.0;
                   })});
  cases.push_back({"mirrored", test::relief(30, 20, Continuation::Mirrored,
                                            [](double c, double r) { return std::sin(0.5 * c) + std::cos(0.7 * r); })});
  cases.push_back({"smallest", test::relief(2, 2, Continuation::Periodic,
                                            [](double c, double r) { return 0.3 * c + 0.2 * r * c; })});
  return cases;
}

bool same_hit(const HitBatch& a, const HitBatch& b, std::size_t k) {
  return a.end[k] == b.end[k] && (a.end[k] != RayEnd::Surface ||
                                  (a.cell_x[k] == b.cell_x[k] && a.cell_y[k] == b.cell_y[k] &&
                                   a.triangle[k] == b.triangle[k] && a.x[k] == b.x[k] && a.y[k] == b.y[k] &&
                                   a.z[k] == b.z[k] && a.slope_x[k] == b.slope_x[k] && a.slope_y[k] == b.slope_y[k]));
}

TEST(HeightFieldTracer, AgreesWithEmbreeHitByHit) {
  for (const auto& [name, field] : reliefs()) {
    const PeriodicTile tile(field);
    const HeightFieldTracer fast(tile);
    const ReliefScene reference(tile);
    for (const Side side : {Side::Outside, Side::Inside}) {
      for (const double theta : {0.0, 45.0, 80.0}) {
        RayBatch rays = test::beam(tile, 4000, theta, side);
        HitBatch hits(rays.size()), expected(rays.size());
        for (int bounce = 0; bounce < 2; ++bounce) {
          fast.closest_hits(rays, rays.size(), hits);
          reference.closest_hits(rays, rays.size(), expected);
          int apart = 0;
          for (std::size_t k = 0; k < rays.size(); ++k) {
            // Both are right to single precision; a ray that grazes a crest may pass on either side of it.
            if (hits.end[k] != expected.end[k])
              ++apart;
            else if (hits.end[k] == RayEnd::Surface && std::abs(hits.z[k] - expected.z[k]) > 2e-3F)
              ++apart;
          }
          EXPECT_LE(apart, 8) << name << " at " << theta << "°, bounce " << bounce;  // 2 in 1000; measured: 0 to 3
          rays = test::reflected(rays, hits);
          if (std::any_of(hits.end.begin(), hits.end.begin() + 4000, [](RayEnd e) { return e != RayEnd::Surface; }))
            break;
        }
      }
    }
  }
}

TEST(HeightFieldTracer, FindsTheSameHitsWithEveryInstructionSet) {
  for (const auto& [name, field] : reliefs()) {
    const PeriodicTile tile(field);
    const HeightFieldTracer tracer(tile);
    const RayBatch rays = test::beam(tile, 3001, 70.0, Side::Outside);  // no whole number of vectors
    HitBatch best(rays.size());
    tracer.closest_hits(rays, rays.size(), best);
    for (const std::int64_t target : std::vector<std::int64_t>{HWY_EMU128, HWY_AVX2, HWY_AVX3}) {
      if ((hwy::SupportedTargets() & target) == 0) continue;  // not on this machine
      hwy::SetSupportedTargetsForTest(target);
      HitBatch hits(rays.size());
      tracer.closest_hits(rays, rays.size(), hits);
      hwy::SetSupportedTargetsForTest(0);
      for (std::size_t k = 0; k < rays.size(); ++k) ASSERT_TRUE(same_hit(hits, best, k)) << name << " ray " << k;
    }
  }
}

TEST(HeightFieldTracer, LetsNothingThroughTheSurface) {
  for (const auto& [name, field] : reliefs()) {
    const PeriodicTile tile(field);
    const HeightFieldTracer tracer(tile);
    for (const double theta : {0.0, 60.0, 89.9}) {
      RayBatch rays = test::beam(tile, 4096, theta, Side::Outside);
      HitBatch hits(rays.size());
      tracer.closest_hits(rays, rays.size(), hits);
      for (std::size_t k = 0; k < rays.size(); ++k) ASSERT_EQ(hits.end[k], RayEnd::Surface) << name;
      rays = test::reflected(rays, hits);
      tracer.closest_hits(rays, rays.size(), hits);
      for (std::size_t k = 0; k < rays.size(); ++k) {
        ASSERT_TRUE(hits.end[k] == RayEnd::Surface || hits.end[k] == RayEnd::Above) << name << " at " << theta;
      }
    }
  }
}

TEST(BeamFront, StartsNoRayBelowItsFirstHit) {
  for (const auto& [name, field] : reliefs()) {
    const PeriodicTile tile(field);
    const HeightFieldTracer tracer(tile);
    for (const double theta : {0.0, 45.0, 80.0, 89.0}) {
      RayBatch rays = test::beam(tile, 4096, theta, Side::Outside);
      const Direction way(std::sin(Angle::from_degrees(theta).radians()) * 0.8,
                          std::sin(Angle::from_degrees(theta).radians()) * 0.6,
                          -std::cos(Angle::from_degrees(theta).radians()));
      const BeamFront front(tracer.pyramid(), way, 0.0);
      RayBatch from_top(4096), from_front(4096);
      const RandomStream random(3, RandomPurpose::Test);
      for (std::size_t k = 0; k < 4096; ++k) {
        const auto u = random.uniform4(k);
        const double x = u[0] * tile.columns(), y = u[1] * tile.rows(), top = tile.highest() + 0.01;
        const double start = double{front.height(static_cast<std::int32_t>(x), static_cast<std::int32_t>(y))};
        test::set_ray(from_top, k, x + top * front.shift_x(), y + top * front.shift_y(), top, way, Side::Outside, tile);
        test::set_ray(from_front, k, x + start * front.shift_x(), y + start * front.shift_y(), start, way,
                      Side::Outside, tile);
      }
      HitBatch expected(4096), hits(4096);
      tracer.closest_hits(from_top, 4096, expected);
      tracer.closest_hits(from_front, 4096, hits);
      int apart = 0;
      for (std::size_t k = 0; k < 4096; ++k) {
        ASSERT_EQ(hits.end[k], RayEnd::Surface);
        if (std::abs(hits.z[k] - expected.z[k]) > 2e-3F) ++apart;
      }
      EXPECT_LE(apart, 8) << name << " at " << theta;  // grazed crests, by single precision over many tiles
    }
  }
}

}  // namespace
}  // namespace mezzotint
