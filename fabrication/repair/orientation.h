#pragma once

#include <cstddef>

#include "fabrication/part/part_mesh.h"

/// Inside of fabrication/repair.

namespace mezzotint {

/// Turns triangles so that neighbours across edges of two agree; of each shell, as few as can be. Returns how many.
/// @throws MethodError for a shell of one side, as a Möbius strip has
std::size_t agree_on_sides(PartMesh& mesh);

/// Turns the closed pieces of a part that face the wrong way: a piece within an even number of others faces out, within
/// an odd number in. One piece is within another where its box is and eight of its triangles' inner points are, so
/// that solids which overlap stay as they are. Returns how many pieces were turned.
std::size_t face_outwards(PartMesh& mesh);

}  // namespace mezzotint
