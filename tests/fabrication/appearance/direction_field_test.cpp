#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "fabrication/appearance/direction_field.h"
#include "forward/base/error.h"
#include "tests/fabrication/appearance/shapes.h"

namespace mezzotint {
namespace {

using Eigen::Vector3d;
using Kind = FieldGuide::Kind;

SmoothSurface surface_of(const PartMesh& mesh) { return smooth_surface(mesh, 40.0_deg); }

// Poincaré and Hopf: the indices of any field add up to the surface's Euler characteristic.
TEST(DirectionField, ItsIndicesAddUpToTheEulerCharacteristic) {
  for (const Kind kind : {Kind::None, Kind::Axis, Kind::Curvature}) {
    EXPECT_EQ(direction_field(surface_of(sphere(1.0, 4)), {.kind = kind}).index_sum, 2.0);
    const DirectionField around = direction_field(surface_of(torus(1.0, 0.4, 48, 24)), {.kind = kind});
    EXPECT_EQ(around.index_sum, 0.0);
    if (kind != Kind::Axis) {
      EXPECT_TRUE(around.singularities.empty());
    }
  }
}

TEST(DirectionField, TheSmoothestOneOfASphereHasFourHalves) {
  const DirectionField field = direction_field(surface_of(sphere(1.0, 4)), {.kind = Kind::None});
  EXPECT_EQ(field.singularities.size(), 4U);
  for (const FieldSingularity& one : field.singularities) EXPECT_EQ(one.index, 0.5);
}

TEST(DirectionField, FollowsAnAxis) {
  const SmoothSurface surface = surface_of(cylinder(1.0, 2.0, 48, 6));
  for (const double turn : {0.0, 30.0, 90.0}) {
    const DirectionField field =
        direction_field(surface, {.axis = {0, 0, 5}, .turn = Angle::from_degrees(turn), .smoothing = 0.2_mm});
    for (std::size_t node = 0; node < surface.normals.size(); ++node) {
      const Vector3d& n = surface.normals[node];
      EXPECT_NEAR(field.directions[node].norm(), 1.0, 1e-12);
      EXPECT_NEAR(field.directions[node].dot(n), 0.0, 1e-12);
      if (std::abs(n.z()) > 0.5) continue;
      // Counter-clockwise seen from outside.
      const Vector3d wanted = Eigen::AngleAxisd(turn * std::numbers::pi / 180.0, n) * Vector3d::UnitZ();
      EXPECT_NEAR(std::abs(field.directions[node].dot(wanted)), 1.0, 1e-6);
    }
  }
}

TEST(DirectionField, FollowsTheCurvatureOfATorus) {
  const SmoothSurface surface = surface_of(torus(1.0, 0.3, 64, 32));
  const std::vector<Vector3d> bending = bending_directions(surface);
  const DirectionField field = direction_field(surface, {.kind = Kind::Curvature, .smoothing = 0.1_mm});
  for (std::size_t node = 0; node < surface.normals.size(); ++node) {
    const Vector3d& at = surface.vertices_mm[surface.node_vertices[node]];
    const double r = std::hypot(at.x(), at.y()), phi = std::atan2(at.y(), at.x());
    const Vector3d around(-std::sin(phi), std::cos(phi), 0.0);  // the long way; the tube bends across it
    EXPECT_NEAR(field.directions[node].dot(around), 0.0, 0.02);
    // 1/tube − cos v/r, cos v = (r − 1)/tube.
    const double difference = 1.0 / 0.3 - (r - 1.0) / 0.3 / r;
    EXPECT_NEAR(bending[node].norm(), difference, 0.05 * difference);
  }
}

TEST(DirectionField, IsContinuousAcrossEdges) {
  const SmoothSurface surface = surface_of(sphere(1.0, 3));
  const DirectionField field = direction_field(surface, {});
  double most = 0.0;
  for (std::uint32_t t = 0; t < surface.corners.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t owner = surface.edges[surface.sides[t].at(k)].owner;
      if (owner == t) continue;
      Vector3d here = Vector3d::Zero(), there = Vector3d::Zero();
      for (std::size_t i = 0; i < 3; ++i) {
        const double weight = i == k ? 0.3 : 0.7;
        if (i == (k + 2) % 3) continue;
        here[static_cast<Eigen::Index>(i)] = weight;
        for (std::size_t j = 0; j < 3; ++j)
          if (surface.corners[owner].at(j) == surface.corners[t].at(i)) there[static_cast<Eigen::Index>(j)] = weight;
      }
      const Vector3d a = frame_at(surface, field.directions, t, here).along,
                     b = frame_at(surface, field.directions, owner, there).along;
      most = std::max(most, 1.0 - std::abs(a.dot(b)));
    }
  }
  EXPECT_LT(most, 1e-12);
}

TEST(DirectionField, RefusesWhatMakesNoSense) {
  const SmoothSurface surface = surface_of(sphere(1.0, 1));
  EXPECT_THROW((void)direction_field(surface, {.axis = Vector3d::Zero()}), InvalidInput);
  EXPECT_THROW((void)direction_field(surface, {.smoothing = -1.0_mm}), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
