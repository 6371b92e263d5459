#include "forward/tracing/relief_scene.h"

#include <cmath>
#include <memory>
#include <optional>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "forward/base/random.h"
#include "forward/tracing/height_field_tracer.h"
#include "tests/forward/scattering/reliefs.h"
#include "tests/forward/tracing/tracers.h"

namespace mezzotint {
namespace {

constexpr std::uint32_t columns = 12, rows = 10;
constexpr double pitch_y_um = 1.3;

HeightField small_relief() {
  const RandomStream random(5, RandomPurpose::Test);
  return test::relief(
      columns, rows, Continuation::Periodic,
      [&](double c, double r) { return 1.5 * random.uniform4(static_cast<std::uint64_t>(100.0 * c + r))[0]; },
      pitch_y_um);
}

struct PlainRay {
  Eigen::Vector3d origin, direction;
  Side side;
};

// Every triangle of every copy that a ray of 60 cells can reach, in double, by Möller and Trumbore's formula: how far.
std::optional<double> closest_by_trying_all(const HeightField& field, double middle, const PlainRay& ray) {
  std::optional<double> closest;
  const auto z = [&](int c, int r) { return field.at((c % 12 + 12) % 12, (r % 10 + 10) % 10) - middle; };
  const auto vertex = [&](int c, int r) -> Eigen::Vector3d { return {c * 1.0, r * pitch_y_um, z(c, r)}; };
  const auto meet = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
    const Eigen::Vector3d e1 = b - a, e2 = c - a, p = ray.direction.cross(e2), s = ray.origin - a, q = s.cross(e1);
    const double determinant = e1.dot(p);
    if (ray.side == Side::Outside ? determinant <= 0.0 : determinant >= 0.0) return;
    const double u = s.dot(p) / determinant, v = ray.direction.dot(q) / determinant, t = e2.dot(q) / determinant;
    if (u < 0.0 || v < 0.0 || u + v > 1.0 || t < 0.0) return;
    if (!closest || t < *closest) closest = t;
  };
  for (int r = -60; r < 70; ++r) {
    for (int c = -64; c < 76; ++c) {
      meet(vertex(c, r), vertex(c + 1, r), vertex(c + 1, r + 1));
      meet(vertex(c, r), vertex(c + 1, r + 1), vertex(c, r + 1));
    }
  }
  return closest;
}

class EitherTracer : public testing::TestWithParam<const char*> {
protected:
  static std::unique_ptr<ReliefTracer> make(const PeriodicTile& tile) {
    if (GetParam() == std::string("embree")) return std::make_unique<ReliefScene>(tile);
    return std::make_unique<HeightFieldTracer>(tile);
  }
};
INSTANTIATE_TEST_SUITE_P(Of, EitherTracer, testing::Values("embree", "height_field"),
                         [](const auto& tracer) { return std::string(tracer.param); });

TEST_P(EitherTracer, FindsTheTriangleThatTryingAllOfThemFinds) {
  const HeightField field = small_relief();
  const HeightRange range = height_range(field);
  const double middle = 0.5 * (range.lowest.um() + range.highest.um());
  const PeriodicTile tile(field);
  const auto tracer = make(tile);
  for (const Side side : {Side::Outside, Side::Inside}) {
    // Steep enough to be through within 60 cells.
    RayBatch rays = test::beam(tile, 200, 80.0, side);
    HitBatch hits(rays.size());
    tracer->closest_hits(rays, rays.size(), hits);
    for (std::size_t k = 0; k < rays.size(); ++k) {
      ASSERT_EQ(hits.end[k], RayEnd::Surface);
      const PlainRay ray{
          {rays.cell_x[k] + double{rays.x[k]}, (rays.cell_y[k] + double{rays.y[k]}) * pitch_y_um, double{rays.z[k]}},
          {double{rays.dx[k]}, double{rays.dy[k]}, double{rays.dz[k]}},
          side};
      const auto expected = closest_by_trying_all(field, middle, ray);
      ASSERT_TRUE(expected.has_value());
      const Eigen::Vector3d place = ray.origin + *expected * ray.direction;
      // Single precision over up to 40 cells, at an angle of incidence up to 89° or so. Whole tiles do not count.
      const double gap_x = place.x() - hits.cell_x[k] - double{hits.x[k]};
      const double gap_y = place.y() / pitch_y_um - hits.cell_y[k] - double{hits.y[k]};
      EXPECT_NEAR(std::remainder(gap_x, columns), 0.0, 5e-4) << "ray " << k;
      EXPECT_NEAR(std::remainder(gap_y, rows), 0.0, 5e-4) << "ray " << k;
      EXPECT_NEAR(place.z(), double{hits.z[k]}, 5e-4) << "ray " << k;
      const double facing =
          ray.direction.z() - ray.direction.x() * double{hits.slope_x[k]} - ray.direction.y() * double{hits.slope_y[k]};
      EXPECT_TRUE(side == Side::Outside ? facing < 0.0 : facing > 0.0);
    }
  }
}

TEST_P(EitherTracer, LetsRaysOutAboveAndBelow) {
  const PeriodicTile tile(small_relief());
  const auto tracer = make(tile);
  RayBatch rays(2);
  const Direction up = Direction(0.9, 0.1, 0.2).normalized();
  test::set_ray(rays, 0, 6.0, 5.0, tile.highest(), up, Side::Outside, tile);
  test::set_ray(rays, 1, 6.0, 5.0, tile.lowest(), -up, Side::Inside, tile);
  HitBatch hits(2);
  tracer->closest_hits(rays, 2, hits);
  EXPECT_EQ(hits.end[0], RayEnd::Above);
  EXPECT_EQ(hits.end[1], RayEnd::Below);
}

TEST_P(EitherTracer, DoesNotMeetTheTriangleThatARayHasJustLeft) {
  const PeriodicTile tile(small_relief());
  const auto tracer = make(tile);
  RayBatch rays(6 * columns * rows);
  std::size_t k = 0;
  for (std::uint32_t triangle = 0; triangle < 2 * columns * rows; ++triangle) {
    // Straight up from a corner of it, and from within: nothing of a height field lies there.
    for (const auto& [u, v] : {std::pair{0.0, 0.0}, {0.3, 0.3}, {1.0, 0.0}}) {
      const Eigen::Vector3d at = tile.point(triangle, u, v);
      const double x = at.x() + 0.5 * tile.length_x(), y = (at.y() + 0.5 * tile.length_y()) / tile.cell_y();
      test::set_ray(rays, k, x, y, at.z(), {0.0, 0.0, 1.0}, Side::Outside, tile);
      rays.cell_x[k] = static_cast<std::int32_t>(triangle / 2 % columns);
      rays.cell_y[k] = static_cast<std::int32_t>(triangle / 2 / columns);
      rays.x[k] = static_cast<float>(x - rays.cell_x[k]);
      rays.y[k] = static_cast<float>(y - rays.cell_y[k]);
      rays.left[k++] = static_cast<std::uint8_t>(triangle % 2);
    }
  }
  HitBatch hits(rays.size());
  tracer->closest_hits(rays, rays.size(), hits);
  for (std::size_t ray = 0; ray < rays.size(); ++ray) EXPECT_EQ(hits.end[ray], RayEnd::Above) << ray;
}

TEST_P(EitherTracer, GivesUpOnARayThatGoesAlongTheHorizonForEver) {
  // A pit in a plain: the ray stays level in it, and never comes above the highest point.
  const auto plain = [](double c, double) { return c == 3.0 ? 1.0 : 0.0; };
  const PeriodicTile tile(test::relief(8, 8, Continuation::Periodic, plain));
  const auto tracer = make(tile);
  RayBatch rays(1);
  test::set_ray(rays, 0, 6.0, 0.5, 0.1, {0.0, 1.0, 0.0}, Side::Outside, tile);
  HitBatch hits(1);
  tracer->closest_hits(rays, 1, hits);
  EXPECT_EQ(hits.end[0], RayEnd::Lost);
}

}  // namespace
}  // namespace mezzotint
