#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "fabrication/appearance/appearance.h"
#include "forward/base/error.h"
#include "tests/fabrication/appearance/shapes.h"

namespace mezzotint {
namespace {

using Eigen::Vector3d;

// The triangle of a box, and the point in it, that lie nearest to a place.
SurfacePoint point_at(const SmoothSurface& surface, const Vector3d& place) {
  SurfacePoint best;
  double least = 1e300;
  for (std::uint32_t t = 0; t < surface.corners.size(); ++t) {
    const auto& [a, b, c] = surface.corners[t];
    const Vector3d &p = surface.vertices_mm[a], &q = surface.vertices_mm[b], &r = surface.vertices_mm[c];
    const Vector3d n = (q - p).cross(r - p);
    const Vector3d w(n.dot((r - q).cross(place - q)), n.dot((p - r).cross(place - r)), n.dot((q - p).cross(place - p)));
    const Vector3d weights = w / n.squaredNorm();
    const double away = std::abs(n.normalized().dot(place - p)) + std::max(0.0, -weights.minCoeff());
    if (away < least) {
      least = away;
      best = {t, weights, place};
    }
  }
  return best;
}

double height_at(const ClothedPart& clothed, const Vector3d& place) {
  return clothed.relief.make_probe()(point_at(clothed.surface, place));
}

// Constant heights, told apart: a plateau of noise that is cut at its top is as good as constant.
Pattern plateau(double height_um) { return Noise{.scale = 1e5_um, .height = Length::from_um(height_um), .seed = 2}; }

TEST(Appearance, GroupsOfFacesHaveTheirOwnPatterns) {
  PartMesh part = box(1.0, 1.0, 1.0);
  part.group_names = {"sides", "lid"};
  part.groups.assign(12, 0);
  part.groups[2] = part.groups[3] = 1;
  Appearance appearance;
  appearance.pattern = plateau(4.0);
  appearance.regions = {{plateau(12.0), 0, "lid"}};
  const ClothedPart clothed = clothe(part, appearance);
  EXPECT_NEAR(height_at(clothed, {0.5, 0.4, 1.0}) / height_at(clothed, {0.0, 0.4, 0.5}), 3.0, 0.05);
  EXPECT_EQ(clothed.relief.highest, 12.0_um);
  appearance.regions = {{std::nullopt, 0, "lid"}};
  EXPECT_EQ(height_at(clothe(part, appearance), {0.5, 0.4, 1.0}), 0.0);
  appearance.regions = {{plateau(12.0), 0, "floor"}};
  EXPECT_THROW((void)clothe(part, appearance), InvalidInput);
}

TEST(Appearance, APictureIsLaidOnWhatFacesIt) {
  const PartMesh part = box(1.0, 1.0, 1.0);
  Appearance appearance;
  appearance.pattern = plateau(4.0);
  // Two by one pixels of 0.2 mm in the middle: label 1 on the left, 2 on the right.
  appearance.picture = ProjectedLabels{Vector3d::UnitZ(), 200.0_um, 2, 1, {1, 2}, {}, {}};
  appearance.regions = {{plateau(8.0), 1, ""}, {std::nullopt, 2, ""}};
  const ClothedPart top = clothe(part, appearance);
  const double base = height_at(top, {0.1, 0.1, 1.0});
  EXPECT_GT(base, 1.0);
  EXPECT_NEAR(height_at(top, {0.4, 0.5, 1.0}) / base, 2.0, 0.05);
  EXPECT_EQ(height_at(top, {0.6, 0.5, 1.0}), 0.0);
  EXPECT_NEAR(height_at(top, {0.4, 0.5, 0.0}) / base, 1.0, 0.05);  // its back
  // From the front (−y looks at it): x is the part's x, y is z.
  appearance.picture->axis = -Vector3d::UnitY();
  const ClothedPart front = clothe(part, appearance);
  EXPECT_NEAR(height_at(front, {0.4, 0.0, 0.5}) / base, 2.0, 0.05);
  EXPECT_EQ(height_at(front, {0.6, 0.0, 0.5}), 0.0);
  EXPECT_NEAR(height_at(front, {0.4, 1.0, 0.5}) / base, 1.0, 0.05);
}

// On a face that looks up the field is the plane's x axis: ridges lie as they do in the plane.
TEST(Appearance, ALidHasThePlanesRidges) {
  Appearance appearance;
  appearance.pattern = Ridges{.wavelength = 100.0_um, .direction = 30.0_deg, .height = 16.0_um};
  const ClothedPart clothed = clothe(box(1.0, 1.0, 0.5), appearance);
  EXPECT_EQ(clothed.waves.size(), 1U);
  const ReliefProbe probe = clothed.relief.make_probe();
  const double steep = Angle(30.0_deg).radians();
  const Vector3d wave(std::cos(steep), std::sin(steep), 0.0);
  const Vector3d across(-wave.y(), wave.x(), 0.0), from(0.45, 0.4, 0.5);
  const auto at = [&](const Vector3d& place) { return probe(point_at(clothed.surface, place)); };
  for (const double step : {0.01, 0.03}) {
    EXPECT_NEAR(at(from + 0.1 * wave + step * across), at(from), 0.1);
    EXPECT_NEAR(at(from + 0.05 * wave + step * across), 16.0 - at(from), 0.1);
  }
}

// Triangles without area, as slicing without repair may meet them, change nothing.
TEST(Appearance, TrianglesWithoutAreaDoNoHarm) {
  PartMesh part = box(1.0, 1.0, 0.5);
  const auto base = static_cast<std::uint32_t>(part.vertices_mm.size());
  part.vertices_mm.insert(part.vertices_mm.end(), {{0.2, 0.2, 0.2}, {0.3, 0.2, 0.2}, {0.4, 0.2, 0.2}});
  part.triangles.push_back({base, base + 1, base + 2});
  part.triangles.push_back({base, base, base + 1});
  Appearance appearance;
  appearance.pattern = Ridges{.wavelength = 200.0_um, .height = 16.0_um};
  const ClothedPart clothed = clothe(part, appearance);
  EXPECT_TRUE(std::isfinite(height_at(clothed, {0.55, 0.4, 0.5})));
  EXPECT_LT(clothed.waves.at(0).wavelength_error, 1e-3);
  EXPECT_EQ(clothed.waves.at(0).defects, 0U);
}

TEST(Appearance, RefusesWhatMakesNoSense) {
  const PartMesh part = box(1.0, 1.0, 1.0);
  EXPECT_THROW((void)clothe(part, {}), InvalidInput);
  Appearance appearance;
  appearance.regions = {{plateau(4.0), 3, ""}};
  EXPECT_THROW((void)clothe(part, appearance), InvalidInput);
  appearance.regions = {{plateau(4.0), 0, "lid"}};
  EXPECT_THROW((void)clothe(part, appearance), InvalidInput);
  appearance.picture = ProjectedLabels{Vector3d::UnitZ(), 10.0_um, 3, 3, {}, {}, {}};
  EXPECT_THROW((void)clothe(part, appearance), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
