#pragma once

#include <array>
#include <cstddef>

#include "fabrication/part/edge_table.h"
#include "fabrication/part/part_mesh.h"

namespace mezzotint {

/// What can be counted and measured of a part's surface as it stands.
///
/// Units    millimetres. Sums are compensated: 1e-12 relative for a closed part, wherever it lies.
struct MeshFacts {
  std::size_t triangles = 0;
  std::size_t vertices = 0;  ///< as the mesh has them; `read_part` has made places one and left unused ones out
  std::array<double, 3> low_mm{}, high_mm{};  ///< the box about the vertices that triangles use
  double area_mm2 = 0.0;
  /// ∮ z dA, positive where triangles face out of the material. Of a surface that is not closed it depends on the
  /// origin and is only a figure to compare.
  double volume_mm3 = 0.0;
  std::size_t bodies = 0;  ///< shells: pieces that hold together through edges of two triangles; a cavity is one too
  std::size_t boundary_edges = 0;      ///< one triangle
  std::size_t non_manifold_edges = 0;  ///< more than two
  std::size_t inconsistent_edges = 0;  ///< two triangles that walk it in the same direction: one of them is inside out
  std::size_t unbalanced_edges = 0;    ///< as many triangles walk it one way as the other: not so
  std::size_t degenerate_triangles = 0;  ///< without area to the rounding of a double

  /// Bounds a volume: what a slicer needs. Bodies may share edges.
  [[nodiscard]] bool closed() const { return triangles > 0 && unbalanced_edges == 0; }
  /// Closed, and every edge between two triangles that agree on the outside.
  [[nodiscard]] bool watertight() const {
    return triangles > 0 && boundary_edges == 0 && non_manifold_edges == 0 && inconsistent_edges == 0;
  }
};

/// @throws InvalidInput as `EdgeTable`
[[nodiscard]] MeshFacts mesh_facts(const PartMesh& mesh);

/// The same where the edges and shells are at hand.
[[nodiscard]] MeshFacts mesh_facts(const PartMesh& mesh, const EdgeTable& edges, const Shells& shells);

}  // namespace mezzotint
