#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "fabrication/part/mesh_facts.h"
#include "fabrication/part/part_mesh.h"

namespace mezzotint {

struct RepairOptions {
  /// Borders closer than this share of the box's diagonal are one: some ten roundings of a text of six digits, and
  /// 0.3 µm of a part of 20 mm. Only vertices of open edges are moved.
  double snap_share = 1e-5;
  /// A hole with more edges is not filled: the surface across it would be invented, and takes its cube of time.
  std::size_t longest_hole = 2000;
  /// Looks for self-intersections of a sound part too (7 ms a thousand triangles); of a mended one it always does.
  bool count_self_intersections = false;
};

/// What was mended. All counts are 0 for a sound part.
struct RepairSummary {
  MeshFacts before, after;
  std::size_t collapsed_removed = 0;   ///< triangles whose corners are not three vertices
  std::size_t duplicates_removed = 0;  ///< triangles that lie on one another, and pairs that face each other
  std::size_t vertices_joined = 0;     ///< of open edges, by `snap_share`
  std::size_t triangles_turned = 0;    ///< to agree with their neighbours
  std::size_t shells_turned = 0;       ///< to face out of the material; those in a cavity's place into the cavity
  std::size_t edges_stitched = 0;      ///< pairs of open edges at the same place
  std::size_t holes_filled = 0;
  std::size_t triangles_added = 0;
  std::size_t scraps_removed = 0;  ///< open pieces that bound nothing
  /// Pairs of triangles that cross; nothing where it was not looked for. They are left as they are.
  std::optional<std::size_t> self_intersections;

  [[nodiscard]] bool changed() const;
  /// One sentence for each kind of change and for what the user should know; empty for a sound part.
  [[nodiscard]] std::vector<std::string> sentences() const;
};

struct RepairedPart {
  PartMesh mesh;
  RepairSummary summary;
};

/// Makes of a part's triangles the boundary of a solid: closed, facing out of the material, cavities into themselves.
///
/// A sound part comes back as it is, after a count of its edges and no more. What the triangles' numbers tell is mended
/// from them: collapsed and duplicate triangles, turned ones, shells that are inside out. What is open goes to
/// CGAL: non-manifold edges are split, borders stitched, holes filled. A hole whose filling is larger than half of
/// its piece is none: the piece is a sheet, a scrap, and is left out. Filled triangles are in the group "filled".
/// Self-intersections are counted, never changed.
///
/// @throws InvalidInput for no triangle
/// @throws MethodError with the reason where no closed body can be made of it
[[nodiscard]] RepairedPart repair_part(PartMesh mesh, const RepairOptions& options = {});

}  // namespace mezzotint
