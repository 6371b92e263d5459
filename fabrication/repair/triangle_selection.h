#pragma once

#include <vector>

#include "fabrication/part/part_mesh.h"

/// Inside of fabrication/repair.

namespace mezzotint {

/// Keeps the triangles that are wanted, with their groups; vertices stay.
void keep_triangles(PartMesh& mesh, const std::vector<bool>& wanted);

/// Leaves out triangles whose corners are not three vertices. Returns how many.
std::size_t remove_collapsed(PartMesh& mesh);

/// Of triangles with the same three vertices, keeps one where more face one way than the other, else none.
/// Returns how many were left out.
std::size_t remove_duplicates(PartMesh& mesh);

/// Joins vertices of open edges that are closer than `distance_mm`. Returns how many are gone; triangles may collapse.
std::size_t join_open_vertices(PartMesh& mesh, double distance_mm);

/// Leaves out vertices that no triangle uses.
void remove_unused_vertices(PartMesh& mesh);

}  // namespace mezzotint
