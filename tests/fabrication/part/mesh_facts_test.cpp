#include "fabrication/part/mesh_facts.h"

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "tests/fabrication/part/solids.h"

namespace mezzotint {
namespace {

TEST(MeshFacts, OfABoxAreThoseOfABox) {
  const MeshFacts facts = mesh_facts(test::box({1.0, 2.0, 3.0}, {2.0, 4.0, 7.0}));
  EXPECT_EQ(facts.triangles, 12U);
  EXPECT_EQ(facts.vertices, 8U);
  EXPECT_EQ(facts.bodies, 1U);
  EXPECT_TRUE(facts.watertight());
  EXPECT_EQ(facts.degenerate_triangles, 0U);
  EXPECT_DOUBLE_EQ(facts.volume_mm3, 8.0);
  EXPECT_DOUBLE_EQ(facts.area_mm2, 28.0);
  EXPECT_EQ(facts.low_mm, (std::array<double, 3>{1.0, 2.0, 3.0}));
  EXPECT_EQ(facts.high_mm, (std::array<double, 3>{2.0, 4.0, 7.0}));
}

// A quadrilateral of a torus of n × m cells is a planar trapezoid only across; its triangles' volume has no short
// closed form, but converges to 2 π² R r² with the square of the cell.
TEST(MeshFacts, OfATorusConvergeToItsVolumeAndAreaWithTheSquareOfTheCell) {
  const double volume = 2.0 * std::numbers::pi * std::numbers::pi * 3.0,
               area = 4.0 * std::numbers::pi * std::numbers::pi * 3.0;
  const MeshFacts coarse = mesh_facts(test::torus(3.0, 1.0, 60, 20)), fine = mesh_facts(test::torus(3.0, 1.0, 120, 40));
  EXPECT_TRUE(fine.watertight());
  EXPECT_NEAR((volume - coarse.volume_mm3) / (volume - fine.volume_mm3), 4.0, 0.1);
  EXPECT_NEAR((area - coarse.area_mm2) / (area - fine.area_mm2), 4.0, 0.1);
  EXPECT_NEAR(fine.volume_mm3, volume, 0.01 * volume);
}

TEST(MeshFacts, VolumeFarFromTheOriginKeepsItsDigits) {
  // Coordinates near 1e6 hold 1e-10: the volume of a unit box is then right to a few of these.
  const MeshFacts facts = mesh_facts(test::box({1e6, -1e6, 1e6}, {1e6 + 1.0, -1e6 + 1.0, 1e6 + 1.0}));
  EXPECT_NEAR(facts.volume_mm3, 1.0, 1e-9);
}

TEST(MeshFacts, VolumeIsNegativeInsideOut) {
  EXPECT_DOUBLE_EQ(mesh_facts(test::inside_out(test::unit_box())).volume_mm3, -1.0);
}

TEST(MeshFacts, CountAHoleATurnedTriangleAndASharedEdge) {
  PartMesh holed = test::unit_box();
  holed.triangles.pop_back();
  const MeshFacts hole = mesh_facts(holed);
  EXPECT_EQ(hole.boundary_edges, 3U);
  EXPECT_FALSE(hole.watertight());
  PartMesh turned = test::unit_box();
  std::swap(turned.triangles[0][0], turned.triangles[0][1]);
  EXPECT_EQ(mesh_facts(turned).inconsistent_edges, 3U);
  // Two boxes that share an edge, and its two vertices.
  PartMesh shared = test::together({test::unit_box(), test::box({1.0, 1.0, 0.0}, {2.0, 2.0, 1.0})});
  for (auto& triangle : shared.triangles)
    for (std::uint32_t& corner : triangle) corner = corner == 8 ? 3 : corner == 12 ? 7 : corner;
  const MeshFacts facts = mesh_facts(shared);
  EXPECT_EQ(facts.non_manifold_edges, 1U);
  EXPECT_EQ(facts.bodies, 2U);
}

TEST(MeshFacts, CollapsedTrianglesAreDegenerateAndHaveNoEdges) {
  PartMesh mesh = test::unit_box();
  mesh.triangles.push_back({1, 1, 2});
  mesh.triangles.push_back({5, 5, 5});
  const MeshFacts facts = mesh_facts(mesh);
  EXPECT_EQ(facts.degenerate_triangles, 2U);
  EXPECT_TRUE(facts.watertight());
  EXPECT_EQ(facts.bodies, 1U);
}

TEST(MeshFacts, RefuseATriangleThatNamesNoVertex) {
  PartMesh mesh = test::unit_box();
  mesh.triangles.push_back({1, 2, 8});
  EXPECT_THROW((void)mesh_facts(mesh), InvalidInput);
}

TEST(MeshFacts, OfNothingAreNothing) { EXPECT_FALSE(mesh_facts(PartMesh{}).watertight()); }

}  // namespace
}  // namespace mezzotint
