#include <map>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "fabrication/appearance/displaced_surface.h"
#include "fabrication/appearance/smooth_surface.h"
#include "fabrication/part/mesh_facts.h"
#include "forward/base/error.h"
#include "tests/fabrication/appearance/shapes.h"

namespace mezzotint {
namespace {

using Eigen::Vector3d;

TEST(SmoothSurface, SplitsABoxAtItsEdgesAndNowhereElse) {
  const SmoothSurface surface = smooth_surface(box(2.0, 3.0, 4.0), 40.0_deg);
  EXPECT_EQ(surface.normals.size(), 24U);  // three a vertex
  EXPECT_EQ(surface.creases.size(), 12U);
  EXPECT_EQ(surface.edges.size(), 18U);
  // The corner at the origin moves all three of its faces by 1.
  EXPECT_NEAR((surface.offsets[0] - Vector3d(-1, -1, -1)).norm(), 0.0, 1e-5);
  for (const auto& crease : surface.creases) EXPECT_NEAR(crease.low.norm(), std::numbers::sqrt2, 1e-5);
}

TEST(SmoothSurface, HasTheSpheresNormals) {
  const SmoothSurface surface = smooth_surface(sphere(1.0, 4), 40.0_deg);
  EXPECT_TRUE(surface.creases.empty());
  for (std::size_t node = 0; node < surface.normals.size(); ++node) {
    const Vector3d outward = surface.vertices_mm[surface.node_vertices[node]] - Vector3d(0, 0, 1);
    EXPECT_GT(surface.normals[node].dot(outward.normalized()), 0.9999);
  }
}

TEST(SmoothSurface, AKnifesEdgeHasABoundedMitre) {
  PartMesh wedge;
  wedge.vertices_mm = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0.5, 20}, {1, 0.5, 20}};
  wedge.triangles = {{0, 2, 1}, {1, 2, 3}, {0, 1, 4}, {1, 5, 4}, {2, 4, 3}, {3, 4, 5}, {0, 4, 2}, {1, 3, 5}};
  const SmoothSurface surface = smooth_surface(wedge, 40.0_deg);
  for (const Vector3d& offset : surface.offsets) EXPECT_LE(offset.norm(), 3.0 + 1e-9);
}

PartMesh mesh_of(const SmoothSurface& surface) {
  PartMesh mesh;
  for (const Vector3d& at : surface.vertices_mm) mesh.vertices_mm.push_back({at.x(), at.y(), at.z()});
  mesh.triangles = surface.corners;
  return mesh;
}

TEST(RefinedSurface, StaysTheSameSurface) {
  for (const PartMesh& part : {box(0.5, 0.3, 0.2), sphere(0.3, 2), cylinder(0.2, 0.5, 24, 1)}) {
    const SmoothSurface surface = refined(smooth_surface(part, 40.0_deg), 50.0_um, 1000000);
    const MeshFacts before = mesh_facts(part), after = mesh_facts(mesh_of(surface));
    EXPECT_TRUE(after.watertight());
    EXPECT_NEAR(after.volume_mm3, before.volume_mm3, 1e-12);
    EXPECT_NEAR(after.area_mm2, before.area_mm2, 1e-12);
    // Every side is found in the mesh's own edges, each edge by its two triangles.
    std::map<std::uint32_t, std::set<std::pair<std::uint32_t, std::uint32_t>>> ends;
    std::map<std::uint32_t, int> triangles;
    double longest = 0.0;
    for (std::size_t t = 0; t < surface.corners.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = surface.corners[t].at(k), b = surface.corners[t].at((k + 1) % 3);
        ends[surface.sides[t].at(k)].insert(std::minmax(a, b));
        ++triangles[surface.sides[t].at(k)];
        longest = std::max(longest, (surface.vertices_mm[a] - surface.vertices_mm[b]).norm());
        EXPECT_EQ(surface.node_vertices[surface.nodes[t].at(k)], a);
      }
    }
    EXPECT_LE(longest, 0.05);
    for (const auto& [edge, pairs] : ends) {
      EXPECT_EQ(pairs.size(), 1U);
      EXPECT_EQ(triangles[edge], 2);
    }
  }
}

TEST(RefinedSurface, IsDisplacedLikeTheOneItCameFrom) {
  const RasterFrame frame{100.0, 0.0, 50.0, 0.0, 0.0, 0.0};
  const SurfaceRelief constant{[]() -> ReliefProbe { return [](const SurfacePoint&) { return 16.0; }; }, Length{},
                               16.0_um};
  const auto volume = [&](const SmoothSurface& surface) {
    double sum = 0.0;
    DisplacedSurface(surface, constant, frame, 7.5_um).for_all_triangles([&](const RasterTriangle& t) {
      const double area = (t[1].x - t[0].x) * (t[2].y - t[0].y) - (t[2].x - t[0].x) * (t[1].y - t[0].y);
      sum += area * (t[0].z + t[1].z + t[2].z) / 6.0;
    });
    return sum;
  };
  for (const PartMesh& part : {box(0.3, 0.3, 0.2), cylinder(0.2, 0.3, 24, 1)}) {
    const SmoothSurface surface = smooth_surface(part, 40.0_deg);
    const double own = volume(surface);
    EXPECT_NEAR(volume(refined(surface, 60.0_um, 1000000)), own, 1e-3 * own);
  }
}

TEST(RefinedSurface, RefusesTooMany) {
  EXPECT_THROW((void)refined(smooth_surface(box(1, 1, 1), 40.0_deg), 10.0_um, 1000), InvalidInput);
  EXPECT_THROW((void)refined(smooth_surface(box(1, 1, 1), 40.0_deg), Length{}, 1000), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
