#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "forward/bsdf_table/incidence_grid.h"
#include "tests/forward/bsdf_table/beckmann_table.h"

namespace mezzotint {
namespace {

using test::degrees;

constexpr SymmetryKind all_kinds[] = {SymmetryKind::None, SymmetryKind::Point, SymmetryKind::Mirror,
                                      SymmetryKind::PointAndMirror, SymmetryKind::Isotropic};

// The normal, and rings of five azimuths at 30° and 60°.
IncidenceGrid example(const BsdfSymmetry& symmetry) {
  IncidenceGrid grid{symmetry, {}};
  std::size_t node = 0;
  for (const double theta : {0.0, 30.0, 60.0}) {
    IncidenceRing ring;
    ring.theta = Angle::from_degrees(theta);
    const bool single = theta == 0.0 || symmetry.kind == SymmetryKind::Isotropic;
    const double steps = range_wraps(symmetry.kind) ? 5.0 : 4.0;
    for (int k = 0; k < (single ? 1 : 5); ++k) {
      ring.azimuths.push_back(Angle::from_radians(single ? 0.0 : azimuth_range(symmetry.kind) * k / steps));
      ring.nodes.push_back(node++);
    }
    grid.rings.push_back(ring);
  }
  return grid;
}

std::vector<DirectionAngles> incidences(const IncidenceGrid& grid) {
  std::vector<DirectionAngles> nodes;
  for (std::size_t ring = 0; ring < grid.rings.size(); ++ring) {
    for (std::size_t k = 0; k < grid.rings[ring].nodes.size(); ++k) nodes.push_back(incidence_at(grid, ring, k));
  }
  return nodes;
}

TEST(IncidenceGrid, GivesANodeToItself) {
  for (const SymmetryKind kind : all_kinds) {
    const IncidenceGrid grid = example({kind, Angle::from_degrees(20)});
    const auto nodes = incidences(grid);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const Direction light = to_direction(nodes[k]);
      double weight = 0.0;
      for (const StencilPart& part : stencil_of(grid, light)) {
        EXPECT_EQ(part.node, k);
        EXPECT_LT((light_for(part, light, nodes[k]) - light).norm(), 1e-12);
        weight += part.weight;
      }
      EXPECT_NEAR(weight, 1.0, 1e-11);
    }
  }
}

// Every part brings the light near its node: in the cell of the grid, nowhere else.
TEST(IncidenceGrid, TurnsTheLightNearItsNodes) {
  for (const SymmetryKind kind : all_kinds) {
    const IncidenceGrid grid = example({kind, Angle::from_degrees(20)});
    const auto nodes = incidences(grid);
    for (int k = 0; k < 72; ++k) {
      const Direction light = to_direction(degrees(47, 5.0 * k + 1.0));
      double weight = 0.0;
      for (const StencilPart& part : stencil_of(grid, light)) {
        const Direction at_node = light_for(part, light, nodes[part.node]);
        const double apart = std::abs(std::remainder((to_angles(at_node).phi - nodes[part.node].phi).degrees(), 360.0));
        EXPECT_LE(apart, 72.0 + 1e-9) << "the widest cell is a fifth of a turn";
        EXPECT_NEAR(std::abs(part.turn.determinant()), 1.0, 1e-14);
        weight += part.weight;
      }
      EXPECT_NEAR(weight, 1.0, 1e-11);
    }
  }
}

TEST(IncidenceGrid, GoesOnWithItsLastRing) {
  const IncidenceGrid grid = example({SymmetryKind::Isotropic, {}});
  const Stencil stencil = stencil_of(grid, to_direction(degrees(80, 10)));
  ASSERT_EQ(stencil.size(), 1U);
  EXPECT_EQ(stencil.begin()->node, 2U);
}

TEST(IncidenceGrid, GivesANodeOnAMirrorBothItsSides) {
  const IncidenceGrid grid = example({SymmetryKind::Mirror, Angle::from_degrees(20)});
  const Stencil stencil = stencil_of(grid, to_direction(degrees(30, 20)));
  ASSERT_EQ(stencil.size(), 2U);
  EXPECT_NEAR(stencil.begin()->turn.determinant() * (stencil.begin() + 1)->turn.determinant(), -1.0, 1e-14);
}

}  // namespace
}  // namespace mezzotint
