#include "forward/scattering/relief_scene.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <cmath>
#include <optional>

#include "forward/base/random.h"
#include "tests/forward/scattering/reliefs.h"

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

// Every triangle of every copy that a ray of 60 cells can reach, in double, by Möller and Trumbore's formula.
std::optional<double> closest_by_trying_all(const HeightField& field, double middle, const Ray& ray) {
  std::optional<double> closest;
  const auto z = [&](int c, int r) { return field.at((c % 12 + 12) % 12, (r % 10 + 10) % 10) - middle; };
  const auto vertex = [&](int c, int r) -> Eigen::Vector3d { return {c - 6.0, (r - 5.0) * pitch_y_um, z(c, r)}; };
  const auto meet = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
    const Eigen::Vector3d e1 = b - a, e2 = c - a, p = ray.direction.cross(e2), s = ray.origin - a, q = s.cross(e1);
    const double determinant = e1.dot(p);
    if (ray.side == Side::Outside ? determinant <= 0.0 : determinant >= 0.0) return;
    const double u = s.dot(p) / determinant, v = ray.direction.dot(q) / determinant, t = e2.dot(q) / determinant;
    if (u < 0.0 || v < 0.0 || u + v > 1.0 || t < 0.0) return;
    if (!closest || t < *closest) closest = t;
  };
  for (int r = -60; r < 70; ++r) {
    for (int c = -70; c < 82; ++c) {
      meet(vertex(c, r), vertex(c + 1, r), vertex(c + 1, r + 1));
      meet(vertex(c, r), vertex(c + 1, r + 1), vertex(c, r + 1));
    }
  }
  return closest;
}

Ray random_ray(std::uint64_t index, Side side, const PeriodicTile& tile) {
  const RandomStream random(6, RandomPurpose::Test);
  const auto place = random.uniform4(2 * index);
  const auto n = random.normal4(2 * index + 1);
  // Steep enough to be through within 60 cells; down from above, up from below.
  const double up = side == Side::Outside ? -1.0 : 1.0;
  const Direction direction = Direction(n[0], n[1], up * (0.1 + std::abs(n[2]))).normalized();
  const double height = side == Side::Outside ? tile.highest() + 0.005 : tile.lowest() - 0.005;
  return {{12.0 * (place[0] - 0.5), 13.0 * (place[1] - 0.5), height}, direction, side, no_triangle};
}

TEST(ReliefScene, FindsTheTriangleThatTryingAllOfThemFinds) {
  const HeightField field = small_relief();
  const HeightRange range = height_range(field);
  const double middle = 0.5 * (range.lowest.um() + range.highest.um());
  const PeriodicTile tile(field);
  const ReliefScene scene(tile);
  for (const Side side : {Side::Outside, Side::Inside}) {
    for (std::uint64_t index = 0; index < 300; ++index) {
      const Ray ray = random_ray(index, side, tile);
      SurfaceHit hit;
      ASSERT_EQ(scene.closest_hit(ray, hit), RayEnd::Surface);
      const auto expected = closest_by_trying_all(field, middle, ray);
      ASSERT_TRUE(expected.has_value());
      // Single precision of coordinates up to 40 cells (5e-6), at an angle of incidence up to 89° or so.
      EXPECT_NEAR(hit.distance, *expected, 5e-4) << "ray " << index;
      const Eigen::Vector3d gap = ray.origin + hit.distance * ray.direction - hit.position;
      EXPECT_NEAR(gap.x() / 12.0, std::round(gap.x() / 12.0), 1e-4);  // whole tiles away
      EXPECT_NEAR(gap.y() / 13.0, std::round(gap.y() / 13.0), 1e-4);
      EXPECT_NEAR(gap.z(), 0.0, 1e-3);
      const double facing = ray.direction.dot(tile.geometric_normal(hit.triangle));
      EXPECT_TRUE(side == Side::Outside ? facing < 0.0 : facing > 0.0);
    }
  }
}

TEST(ReliefScene, LetsRaysOutAboveAndBelow) {
  const PeriodicTile tile(small_relief());
  const ReliefScene scene(tile);
  SurfaceHit hit;
  const Direction up = Direction(0.9, 0.1, 0.2).normalized();
  EXPECT_EQ(scene.closest_hit({{0, 0, tile.highest()}, up, Side::Outside, no_triangle}, hit), RayEnd::Above);
  EXPECT_EQ(scene.closest_hit({{0, 0, tile.lowest()}, -up, Side::Inside, no_triangle}, hit), RayEnd::Below);
  // A ray on the wrong side sees no face that looks at it.
  EXPECT_EQ(scene.closest_hit({{0, 0, tile.lowest()}, -up, Side::Outside, no_triangle}, hit), RayEnd::Below);
}

TEST(ReliefScene, DoesNotMeetTheTriangleThatARayHasJustLeft) {
  const PeriodicTile tile(small_relief());
  const ReliefScene scene(tile);
  for (std::uint32_t triangle = 0; triangle < 2 * columns * rows; ++triangle) {
    // Straight up from a corner of it, and from within: nothing of a height field lies there.
    for (const auto& [u, v] : {std::pair{0.0, 0.0}, {0.3, 0.3}, {1.0, 0.0}}) {
      SurfaceHit hit;
      const Ray ray{tile.point(triangle, u, v), {0.0, 0.0, 1.0}, Side::Outside, triangle};
      EXPECT_EQ(scene.closest_hit(ray, hit), RayEnd::Above) << triangle;
    }
  }
}

TEST(ReliefScene, GivesUpOnARayThatGoesAlongTheHorizonForEver) {
  const PeriodicTile tile(test::relief(8, 8, Continuation::Periodic, [](double, double) { return 0.0; }));
  const ReliefScene scene(tile);
  SurfaceHit hit;
  EXPECT_EQ(scene.closest_hit({{0, 0, 0.005}, {1.0, 0.0, 0.0}, Side::Outside, no_triangle}, hit), RayEnd::Lost);
}

}  // namespace
}  // namespace mezzotint
