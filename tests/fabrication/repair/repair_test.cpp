#include "fabrication/repair/repair.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "forward/base/random.h"
#include "tests/fabrication/part/solids.h"

namespace mezzotint {
namespace {

PartMesh without(PartMesh mesh, std::size_t begin, std::size_t end) {
  mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(begin),
                       mesh.triangles.begin() + static_cast<std::ptrdiff_t>(end));
  return mesh;
}

// A vertex of its own for each corner: as a reader that does not weld.
PartMesh torn(const PartMesh& mesh) {
  PartMesh soup;
  for (const auto& triangle : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.vertices_mm.size());
    for (const std::uint32_t corner : triangle) soup.vertices_mm.push_back(mesh.vertices_mm[corner]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

std::string refusal(const PartMesh& mesh, const RepairOptions& options = {}) {
  try {
    (void)repair_part(mesh, options);
  } catch (const MethodError& error) {
    return error.what();
  }
  return "";
}

void expect_solid(const RepairedPart& part, double volume, double tolerance = 1e-12) {
  EXPECT_TRUE(part.summary.after.closed());
  EXPECT_NEAR(part.summary.after.volume_mm3, volume, tolerance);
  EXPECT_NEAR(mesh_facts(part.mesh).volume_mm3, volume, tolerance);
}

TEST(Repair, ASoundPartComesBackAsItIs) {
  const PartMesh mesh = test::torus(3.0, 1.0, 30, 12);
  const RepairedPart part = repair_part(mesh);
  EXPECT_EQ(part.mesh.triangles, mesh.triangles);
  EXPECT_EQ(part.mesh.vertices_mm, mesh.vertices_mm);
  EXPECT_FALSE(part.summary.changed());
  EXPECT_TRUE(part.summary.sentences().empty());
  EXPECT_FALSE(part.summary.self_intersections.has_value());
}

TEST(Repair, ShellsFaceOutAndCavitiesIntoThemselves) {
  const PartMesh outer = test::box({0.0, 0.0, 0.0}, {10.0, 10.0, 10.0}),
                 hole = test::box({2.0, 2.0, 2.0}, {6.0, 6.0, 6.0}), core = test::box({3.0, 3.0, 3.0}, {4.0, 4.0, 4.0}),
                 beside = test::box({20.0, 0.0, 0.0}, {21.0, 1.0, 1.0});
  const double volume = 1000.0 - 64.0 + 1.0 + 1.0;
  for (unsigned turned = 0; turned < 16; ++turned) {
    const auto maybe = [&](const PartMesh& mesh, unsigned bit) {
      return (turned & bit) != 0 ? test::inside_out(mesh) : mesh;
    };
    const RepairedPart part =
        repair_part(test::together({maybe(outer, 1), maybe(hole, 2), maybe(core, 4), maybe(beside, 8)}));
    expect_solid(part, volume, 1e-9);
    const unsigned wrong = turned ^ 2U;  // the hole has to face in
    EXPECT_EQ(part.summary.shells_turned, static_cast<std::size_t>(std::popcount(wrong)));
  }
}

TEST(Repair, SolidsThatOverlapStayAsTheyAreAndAreCounted) {
  const PartMesh mesh =
      test::together({test::box({0.0, 0.0, 0.0}, {4.0, 4.0, 4.0}), test::box({3.0, 1.0, 1.0}, {8.0, 2.0, 2.0})});
  const RepairedPart part = repair_part(mesh, {.count_self_intersections = true});
  EXPECT_FALSE(part.summary.changed());
  // Of the small box's four sides along x, each triangle crosses the large one's face x = 4, of two triangles.
  EXPECT_GE(part.summary.self_intersections.value(), 8U);
  EXPECT_FALSE(part.summary.sentences().empty());
}

TEST(Repair, NothingCrossesInWhatTouches) {
  const PartMesh mesh = test::torus(3.0, 1.0, 30, 12);
  EXPECT_EQ(repair_part(mesh, {.count_self_intersections = true}).summary.self_intersections.value(), 0U);
  EXPECT_EQ(repair_part(torn(mesh)).summary.self_intersections.value(), 0U);
}

TEST(Repair, AFoldedNeighbourIsASelfIntersection) {
  // A corner that goes out through the face opposite; the volume, linear in its place, is still a sixth.
  PartMesh mesh = test::unit_box();
  mesh.vertices_mm[0] = {0.5, 0.5, 1.5};
  EXPECT_GT(repair_part(mesh, {.count_self_intersections = true}).summary.self_intersections.value(), 0U);
}

TEST(Repair, TurnedTrianglesAgreeAgain) {
  PartMesh mesh = test::torus(3.0, 1.0, 30, 12);
  const double volume = mesh_facts(mesh).volume_mm3;
  for (const std::size_t k : {5U, 6U, 100U, 333U}) std::swap(mesh.triangles[k][0], mesh.triangles[k][2]);
  const RepairedPart part = repair_part(mesh);
  expect_solid(part, volume, 1e-9);
  EXPECT_EQ(part.summary.triangles_turned, 4U);
  EXPECT_EQ(part.summary.shells_turned, 0U);
}

TEST(Repair, ATornSurfaceIsStitched) {
  const PartMesh mesh = test::torus(3.0, 1.0, 30, 12);
  const RepairedPart part = repair_part(torn(mesh));
  expect_solid(part, mesh_facts(mesh).volume_mm3, 1e-9);
  EXPECT_EQ(part.mesh.triangles.size(), mesh.triangles.size());
  EXPECT_EQ(part.mesh.vertices_mm.size(), mesh.vertices_mm.size());
  EXPECT_EQ(part.summary.triangles_added, 0U);
}

TEST(Repair, GapsOfRoundingAreClosedAndWiderOnesAreNot) {
  PartMesh mesh = torn(test::torus(3.0, 1.0, 30, 12));
  double shift = 1e-6;
  for (auto& vertex : mesh.vertices_mm) {
    vertex[2] += shift;
    shift = -shift;
  }
  const RepairedPart part = repair_part(mesh);
  EXPECT_TRUE(part.summary.after.watertight());
  EXPECT_EQ(part.summary.triangles_added, 0U);
}

TEST(Repair, AHoleIsFilledWithTheTrianglesThatItTakes) {
  const RepairedPart side = repair_part(without(test::unit_box(), 10, 12));
  expect_solid(side, 1.0);
  EXPECT_EQ(side.summary.holes_filled, 1U);
  EXPECT_EQ(side.summary.triangles_added, 2U);
  const PartMesh torus = test::torus(3.0, 1.0, 60, 24);
  const RepairedPart mended = repair_part(without(without(torus, 700, 712), 10, 12));
  EXPECT_EQ(mended.summary.holes_filled, 2U);
  // A fill is flat where the torus is curved: less than the hole's area times its sagitta.
  EXPECT_NEAR(mended.summary.after.volume_mm3, mesh_facts(torus).volume_mm3, 0.1);
  EXPECT_TRUE(mended.summary.after.watertight());
}

TEST(Repair, FilledTrianglesHaveAGroupOfTheirOwn) {
  PartMesh mesh = without(test::unit_box(), 10, 12);
  mesh.group_names = {"a", "b"};
  mesh.groups = {0, 0, 0, 0, 0, 1, 1, 1, 1, 1};
  const RepairedPart part = repair_part(mesh);
  EXPECT_EQ(part.mesh.group_names, (std::vector<std::string>{"a", "b", "filled"}));
  EXPECT_EQ(part.mesh.groups, (std::vector<std::uint32_t>{0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 2, 2}));
}

TEST(Repair, CollapsedAndDuplicateTrianglesAreLeftOut) {
  PartMesh mesh = test::unit_box();
  mesh.triangles.push_back(mesh.triangles[3]);
  mesh.triangles.push_back({1, 1, 2});
  mesh.triangles.push_back({0, 3, 5});  // a pair that faces itself
  mesh.triangles.push_back({3, 0, 5});
  const RepairedPart part = repair_part(mesh);
  expect_solid(part, 1.0);
  EXPECT_EQ(part.summary.collapsed_removed, 1U);
  EXPECT_EQ(part.summary.duplicates_removed, 3U);
  EXPECT_EQ(part.mesh.triangles, test::unit_box().triangles);
}

TEST(Repair, BodiesMayShareAnEdge) {
  PartMesh shared = test::together({test::unit_box(), test::box({1.0, 1.0, 0.0}, {2.0, 2.0, 1.0})});
  for (auto& triangle : shared.triangles)
    for (std::uint32_t& corner : triangle) corner = corner == 8 ? 3 : corner == 12 ? 7 : corner;
  const RepairedPart part = repair_part(shared);
  expect_solid(part, 2.0);
  EXPECT_FALSE(part.summary.changed());
  for (std::size_t k = 12; k < 24; ++k) std::swap(shared.triangles[k][0], shared.triangles[k][1]);
  const RepairedPart turned = repair_part(shared);
  expect_solid(turned, 2.0);
  EXPECT_EQ(turned.summary.shells_turned, 1U);
}

TEST(Repair, ALooseTriangleIsLeftOutBesideASolid) {
  PartMesh loose;
  loose.vertices_mm = {{5.0, 0.0, 0.0}, {6.0, 0.0, 0.0}, {5.0, 1.0, 0.0}};
  loose.triangles = {{0, 1, 2}};
  const RepairedPart part = repair_part(test::together({test::unit_box(), loose}));
  expect_solid(part, 1.0);
  EXPECT_EQ(part.summary.scraps_removed, 1U);
  EXPECT_EQ(part.mesh.vertices_mm.size(), 8U);
  EXPECT_EQ(part.summary.holes_filled, 0U);
}

TEST(Repair, WhereNothingSensibleCanBeDoneItSaysWhy) {
  EXPECT_THROW((void)repair_part(PartMesh{}), InvalidInput);
  PartMesh sheet;
  sheet.vertices_mm = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {1.0, 1.0, 0.0}, {0.0, 1.0, 0.3}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_NE(refusal(sheet).find("sheets"), std::string::npos);
  PartMesh doubled = sheet;
  doubled.triangles.push_back({2, 1, 0});
  doubled.triangles.push_back({3, 2, 0});
  EXPECT_NE(refusal(doubled).find("no volume"), std::string::npos);
  PartMesh collapsed = sheet;
  collapsed.triangles = {{0, 0, 1}};
  EXPECT_NE(refusal(collapsed).find("no volume"), std::string::npos);
  PartMesh strip;  // of Möbius: five vertices, five triangles
  for (int k = 0; k < 5; ++k) strip.vertices_mm.push_back({std::cos(k * 1.3), std::sin(k * 1.3), 0.1 * k});
  strip.triangles = {{0, 1, 2}, {1, 2, 3}, {2, 3, 4}, {3, 4, 0}, {4, 0, 1}};
  EXPECT_NE(refusal(strip).find("one side"), std::string::npos);
  EXPECT_NE(refusal(without(test::torus(3.0, 1.0, 60, 24), 0, 2), {.longest_hole = 3}).find("edges"),
            std::string::npos);
}

// Triangles lost, turned, doubled, torn off and moved to wrong vertices: closed or refused, and never anything else.
TEST(Repair, AnyDamageIsMendedOrRefused) {
  const PartMesh whole = test::torus(3.0, 1.0, 16, 8);
  int mended = 0;
  for (std::uint64_t k = 0; k < 200; ++k) {
    const RandomStream random(k, RandomPurpose::Test);
    PartMesh mesh = whole;
    const auto damages = static_cast<std::uint64_t>(1.0 + 30.0 * random.uniform4(0)[0]);
    for (std::uint64_t n = 1; n <= damages; ++n) {
      const auto draw = random.uniform4(n);
      const auto at = static_cast<std::size_t>(draw[0] * static_cast<double>(mesh.triangles.size()));
      auto& triangle = mesh.triangles[at];
      const auto vertex = static_cast<std::uint32_t>(draw[1] * static_cast<double>(mesh.vertices_mm.size()));
      switch (static_cast<int>(draw[2] * 5.0)) {
        case 0:
          mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(at));
          break;
        case 1:
          std::swap(triangle[0], triangle[1]);
          break;
        case 2:
          mesh.triangles.push_back(std::array<std::uint32_t, 3>(triangle));
          break;
        case 3:
          mesh.vertices_mm.push_back(std::array<double, 3>(mesh.vertices_mm[triangle[0]]));
          triangle[0] = static_cast<std::uint32_t>(mesh.vertices_mm.size() - 1);
          break;
        default:
          triangle[2] = vertex;
      }
    }
    try {
      const RepairedPart part = repair_part(mesh);
      EXPECT_TRUE(mesh_facts(part.mesh).closed()) << k;
      EXPECT_GT(part.summary.after.volume_mm3, 0.0) << k;
      ++mended;
    } catch (const MethodError&) {
    }
  }
  EXPECT_GT(mended, 50);
}

}  // namespace
}  // namespace mezzotint
