#pragma once

#include "fabrication/repair/repair.h"

/// Inside of fabrication/repair: what CGAL does.

namespace mezzotint {

/// Splits non-manifold edges, stitches borders, fills holes and leaves scraps out; counts into `summary`.
/// @throws MethodError where CGAL fails, or nothing is left that bounds a volume
void close_surface(PartMesh& mesh, const RepairOptions& options, RepairSummary& summary);

/// Pairs of triangles that cross, or lie on one another; that they share a vertex or an edge is no crossing.
[[nodiscard]] std::size_t count_self_intersections(const PartMesh& mesh);

}  // namespace mezzotint
