#include <cmath>

#include <gtest/gtest.h>

#include "forward/base/random.h"
#include "measurement/reflectance/triangulation.h"

namespace mezzotint {
namespace {

std::vector<PlanePoint> square_grid(int side) {
  std::vector<PlanePoint> points;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) points.push_back({0.1 * x, 0.1 * y});
  }
  return points;
}

double linear_at(const Triangulation& plane, PlanePoint place) {
  const auto corners = plane.around(place);
  if (!corners) return NAN;
  double sum = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const PlanePoint& point = plane.points()[corners->point[k]];
    sum += corners->weight[k] * (3.0 * point.x - 2.0 * point.y + 0.5);
  }
  return sum;
}

TEST(Triangulation, CoversAGridOnceAndKeepsLinearFunctions) {
  const Triangulation plane(square_grid(12));
  EXPECT_EQ(plane.triangles(), 2U * 11U * 11U);
  for (double x = 0.0; x <= 1.1; x += 0.037) {
    for (double y = 0.0; y <= 1.1; y += 0.041) EXPECT_NEAR(linear_at(plane, {x, y}), 3.0 * x - 2.0 * y + 0.5, 1e-6);
  }
  EXPECT_TRUE(std::isnan(linear_at(plane, {-0.01, 0.5})));
  EXPECT_TRUE(std::isnan(linear_at(plane, {0.5, 1.11})));
}

TEST(Triangulation, FulfilsDelaunaysConditionForScatteredPoints) {
  std::vector<PlanePoint> points;
  const RandomStream stream(7, RandomPurpose::Test);
  for (std::uint64_t i = 0; i < 300; ++i) points.push_back({stream.uniform4(i)[0], stream.uniform4(i)[1]});
  const Triangulation plane(points);
  // Every place inside has a triangle whose circle no other point lies in.
  int inside = 0;
  for (double x = 0.1; x < 0.9; x += 0.05) {
    for (double y = 0.1; y < 0.9; y += 0.05) {
      const auto corners = plane.around({x, y});
      if (!corners) continue;
      ++inside;
      const auto& [a, b, c] = corners->point;
      const PlanePoint p = points[a], q = points[b], r = points[c];
      const double d = 2.0 * ((q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x));
      const double q2 = std::pow(q.x - p.x, 2) + std::pow(q.y - p.y, 2),
                   r2 = std::pow(r.x - p.x, 2) + std::pow(r.y - p.y, 2);
      const double cx = ((r.y - p.y) * q2 - (q.y - p.y) * r2) / d, cy = ((q.x - p.x) * r2 - (r.x - p.x) * q2) / d;
      for (const PlanePoint& other : points)
        EXPECT_GE(std::hypot(other.x - p.x - cx, other.y - p.y - cy), std::hypot(cx, cy) * (1.0 - 1e-6));
    }
  }
  EXPECT_GT(inside, 200);
}

TEST(Triangulation, LeavesGapsOpen) {
  std::vector<PlanePoint> points;
  for (const PlanePoint& point : square_grid(20)) {
    if (std::hypot(point.x - 1.0, point.y - 1.0) > 0.45) points.push_back(point);
  }
  const Triangulation plane(points);
  EXPECT_FALSE(plane.around({1.0, 1.0}));
  EXPECT_TRUE(plane.around({0.3, 0.3}));
}

TEST(Triangulation, TakesAGridThatIsFinerOneWayForWhole) {
  std::vector<PlanePoint> points;
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 6; ++x) points.push_back({0.2 * x, 0.03 * y});
  }
  const Triangulation plane(points);
  EXPECT_EQ(plane.triangles(), 2U * 29U * 5U);
}

TEST(Triangulation, HasNoTrianglesOnALine) {
  EXPECT_EQ(Triangulation({{0.0, 0.0}, {0.1, 0.0}, {0.2, 0.0}, {0.3, 0.0}}).around({0.5, 0.2}), std::nullopt);
}

}  // namespace
}  // namespace mezzotint
