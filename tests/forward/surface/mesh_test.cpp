#include "forward/surface/mesh.h"

#include <gtest/gtest.h>
#include <cmath>
#include <limits>
#include <numbers>

#include "forward/base/error.h"

namespace mezzotint {
namespace {

using namespace literals;

constexpr float missing = std::numeric_limits<float>::quiet_NaN();

HeightField sampled(const Grid& grid, Continuation continuation, const auto& height_um) {
  HeightField field(grid, continuation);
  for (std::size_t r = 0; r < grid.rows; ++r) {
    for (std::size_t c = 0; c < grid.columns; ++c) {
      field.at(c, r) = static_cast<float>(height_um(static_cast<double>(c), static_cast<double>(r)));
    }
  }
  return field;
}

// z component of the cross product of two edges: twice the area in the plane, positive counter-clockwise.
double doubled_area_um2(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  const auto& a = mesh.vertices_um[triangle[0]];
  const auto& b = mesh.vertices_um[triangle[1]];
  const auto& c = mesh.vertices_um[triangle[2]];
  return (double{b[0]} - a[0]) * (double{c[1]} - a[1]) - (double{b[1]} - a[1]) * (double{c[0]} - a[0]);
}

TEST(Mesh, HasAVertexASampleAndTwoTrianglesACell) {
  const TriangleMesh mesh =
      to_mesh(sampled({5, 4, 0.5_um, 2.0_um}, Continuation::Mirrored, [](double c, double r) { return 10.0 * r + c; }));
  ASSERT_EQ(mesh.vertices_um.size(), 20U);
  ASSERT_EQ(mesh.normals.size(), 20U);
  ASSERT_EQ(mesh.triangles.size(), 24U);
  EXPECT_EQ(mesh.vertices_um[7], (std::array<float, 3>{1.0F, 2.0F, 12.0F}));
  double area = 0.0;
  for (const auto& triangle : mesh.triangles) {
    EXPECT_GT(doubled_area_um2(mesh, triangle), 0.0);  // counter-clockwise from +z
    area += 0.5 * doubled_area_um2(mesh, triangle);
  }
  EXPECT_DOUBLE_EQ(area, 2.0 * 6.0);
}

TEST(Mesh, SplitsACellFromItsFirstCornerToTheOppositeOne) {
  const TriangleMesh mesh = to_mesh(HeightField({2, 2, 1.0_um, 1.0_um}, Continuation::Mirrored));
  ASSERT_EQ(mesh.triangles.size(), 2U);
  EXPECT_EQ(mesh.triangles[0], (std::array<std::uint32_t, 3>{0, 1, 3}));
  EXPECT_EQ(mesh.triangles[1], (std::array<std::uint32_t, 3>{0, 3, 2}));
}

TEST(Mesh, LeavesHolesAndUnusedVerticesOut) {
  HeightField field({4, 3, 1.0_um, 1.0_um}, Continuation::Mirrored);
  field.at(0, 0) = missing;  // one cell
  field.at(3, 1) = missing;  // two cells, and with them the last samples of rows 0 and 2
  const TriangleMesh mesh = to_mesh(field);
  EXPECT_EQ(mesh.triangles.size(), 2U * (6 - 3));
  EXPECT_EQ(mesh.vertices_um.size(), 12U - 2 - 2);
  for (const auto& vertex : mesh.vertices_um) EXPECT_FALSE(std::isnan(vertex[2]));
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) ASSERT_LT(corner, mesh.vertices_um.size());
    EXPECT_DOUBLE_EQ(doubled_area_um2(mesh, triangle), 1.0);
  }
}

TEST(Mesh, RefusesAFieldWithoutAWholeCell) {
  EXPECT_THROW((void)to_mesh(HeightField({1, 9, 1.0_um, 1.0_um}, Continuation::Periodic)), InvalidInput);
  EXPECT_THROW((void)to_mesh(HeightField({2, 2, 1.0_um, 1.0_um}, Continuation::Mirrored, {0, 0, 0, missing})),
               InvalidInput);
}

TEST(PseudoNormals, OfAPlaneAreItsNormal) {
  const HeightField plane =
      sampled({6, 5, 0.5_um, 2.0_um}, Continuation::Mirrored, [](double c, double r) { return 0.25 * c - 0.5 * r; });
  // Slopes ½ and −¼: normal (−½, ¼, 1)/√(1 + ¼ + 1/16).
  const double length = std::sqrt(1.3125);
  for (const auto& normal : pseudo_normals(plane)) {
    EXPECT_NEAR(normal[0], -0.5 / length, 1e-7);  // stored in single precision
    EXPECT_NEAR(normal[1], 0.25 / length, 1e-7);
    EXPECT_NEAR(normal[2], 1.0 / length, 1e-7);
  }
}

TEST(PseudoNormals, WeighFacetsByTheirAnglesAndNotByTheirNumber) {
  // A roof along y. On its crest three triangles lean to either side, whose angles add up to 180° a side, so
  // the normal stands upright; an unweighted mean of the facets at the corner (0, 0) below would lean.
  const HeightField roof =
      sampled({3, 3, 1.0_um, 1.0_um}, Continuation::Mirrored, [](double c, double) { return c < 1.5 ? c : 2.0 - c; });
  const auto normals = pseudo_normals(roof);
  EXPECT_NEAR(normals[1 * 3 + 1][0], 0.0, 1e-7);
  EXPECT_NEAR(normals[1 * 3 + 1][2], 1.0, 1e-7);
  // At the end of the crest (1, 0): on the left the upper half-cell's lower right corner (90°, one triangle), on
  // the right two triangles whose angles add up to 90°. Weighted by angle they balance; by number they do not.
  EXPECT_NEAR(normals[1][0], 0.0, 1e-7);
  EXPECT_NEAR(normals[1][1], 0.0, 1e-7);
}

TEST(PseudoNormals, MatchAWorkedCorner) {
  // A pyramid of height 1 over one sample: six facets, all worked by hand from their edges.
  HeightField spike({5, 5, 1.0_um, 1.0_um}, Continuation::Mirrored);
  spike.at(2, 2) = 1.0F;
  const auto normals = pseudo_normals(spike);
  EXPECT_NEAR(normals[12][0], 0.0, 1e-7);  // point symmetry of the split
  EXPECT_NEAR(normals[12][1], 0.0, 1e-7);
  EXPECT_NEAR(normals[12][2], 1.0, 1e-7);
  // Its neighbour at (3, 2), edges of the spike's facets there: W = (−1, 0, 1), flat neighbours N, SW... of height 0.
  // Triangles (N, W) and (W, SW) touch the spike, with SW = (2, 1): N×W = (1, 0, 1), angle acos(0) = 90°;
  // W×SW = (1, −1, 1), angle acos(1/2) = 60°... the other four are flat with 45 + 45 + 45 + 90 = 225°.
  const double right = std::numbers::pi / 2.0, sixty = std::acos(1.0 / (std::sqrt(2.0) * std::sqrt(2.0)));
  const double x = right / std::sqrt(2.0) + sixty / std::sqrt(3.0), y = -sixty / std::sqrt(3.0);
  const double z = right / std::sqrt(2.0) + sixty / std::sqrt(3.0) + 225.0 * std::numbers::pi / 180.0;
  const double length = std::sqrt(x * x + y * y + z * z);
  EXPECT_NEAR(normals[13][0], x / length, 1e-6);  // stored in single precision
  EXPECT_NEAR(normals[13][1], y / length, 1e-6);
  EXPECT_NEAR(normals[13][2], z / length, 1e-6);
}

TEST(PseudoNormals, OfAPeriodicFieldContinueOverItsEnds) {
  const double k = 2.0 * std::numbers::pi / 64.0;
  const auto wave = [&](double c, double r) { return 5.0 * std::sin(k * (c + 2.0 * r)); };
  const HeightField field = sampled({64, 32, 1.0_um, 1.5_um}, Continuation::Periodic, wave);
  const auto normals = pseudo_normals(field);
  for (std::size_t r = 0; r < 32; ++r) {
    for (std::size_t c = 0; c < 64; ++c) {
      const double slope = 5.0 * k * std::cos(k * (static_cast<double>(c) + 2.0 * static_cast<double>(r)));
      const double sx = slope, sy = slope * 2.0 / 1.5, length = std::sqrt(1.0 + sx * sx + sy * sy);
      // Facets instead of the surface: the curvature's change over a cell, h²k²S/6 with k = 0.2 a row: 0.4 % of S.
      EXPECT_NEAR(normals[r * 64 + c][0], -sx / length, 5e-3) << c << ", " << r;
      EXPECT_NEAR(normals[r * 64 + c][1], -sy / length, 5e-3) << c << ", " << r;
    }
  }
}

TEST(ClosedMesh, EndsWhereItsNextCopyBegins) {
  const auto wave = [](double c, double r) { return std::sin(0.7 * c) + std::cos(1.1 * r); };
  const HeightField field = sampled({5, 4, 2.0_um, 3.0_um}, Continuation::Periodic, wave);
  const TriangleMesh mesh = to_closed_mesh(field);
  ASSERT_EQ(mesh.vertices_um.size(), 6U * 5U);
  EXPECT_EQ(mesh.triangles.size(), 2U * 5U * 4U);
  for (std::size_t r = 0; r < 5; ++r) {
    EXPECT_EQ(mesh.vertices_um[6 * r + 5],
              (std::array{10.0F, 3.0F * static_cast<float>(r), mesh.vertices_um[6 * r][2]}));
    EXPECT_EQ(mesh.normals[6 * r + 5], mesh.normals[6 * r]);
  }
  for (std::size_t c = 0; c < 6; ++c) EXPECT_EQ(mesh.vertices_um[24 + c][2], mesh.vertices_um[c][2]);
  EXPECT_THROW((void)to_closed_mesh(crop(field, 0, 0, 3, 3)), InvalidInput);
}

TEST(PseudoNormals, PointUpWhereThereIsNothing) {
  HeightField field({3, 3, 1.0_um, 1.0_um}, Continuation::Mirrored);
  field.at(1, 1) = missing;
  for (const auto& normal : pseudo_normals(field)) EXPECT_EQ(normal, (std::array<float, 3>{0.0F, 0.0F, 1.0F}));
}

}  // namespace
}  // namespace mezzotint
