#include "fabrication/repair/repair.h"

#include <cmath>

#include <fmt/format.h>

#include "fabrication/repair/close_surface.h"
#include "fabrication/repair/orientation.h"
#include "fabrication/repair/triangle_selection.h"
#include "forward/base/error.h"

namespace mezzotint {

namespace {

double diagonal_of(const MeshFacts& facts) {
  return std::hypot(facts.high_mm[0] - facts.low_mm[0], facts.high_mm[1] - facts.low_mm[1],
                    facts.high_mm[2] - facts.low_mm[2]);
}

// Several bodies may be right each; that takes a look at where they stand.
bool is_sound(const MeshFacts& facts) { return facts.closed() && facts.bodies == 1 && facts.volume_mm3 > 0.0; }

// Only where some edge has more than two triangles, or a shell is two triangles, can two be the same.
void mend_by_numbers(PartMesh& mesh, const MeshFacts& facts, const RepairOptions& options, RepairSummary& summary) {
  summary.collapsed_removed += remove_collapsed(mesh);
  if (!facts.closed()) {
    summary.vertices_joined += join_open_vertices(mesh, options.snap_share * diagonal_of(facts));
    summary.collapsed_removed += remove_collapsed(mesh);
    summary.duplicates_removed += remove_duplicates(mesh);
    summary.triangles_turned += agree_on_sides(mesh);
  } else if (facts.non_manifold_edges > 0 || facts.volume_mm3 == 0.0) {
    summary.duplicates_removed += remove_duplicates(mesh);
  }
}

void require_volume(const PartMesh& mesh, const MeshFacts& facts) {
  // Rounding leaves less of a flat part.
  constexpr double least = 1e-12;
  if (mesh.triangles.empty() || !(std::abs(facts.volume_mm3) > least * std::pow(facts.area_mm2, 1.5))) {
    throw MethodError(
        "the part encloses no volume: it is flat, or its walls lie on one another; give it a thickness where it was "
        "modelled");
  }
}

void add_count(std::vector<std::string>& sentences, std::size_t count, std::string_view one, std::string_view many) {
  if (count > 0) sentences.push_back(fmt::format("{} {}", count, count == 1 ? one : many));
}

}  // namespace

bool RepairSummary::changed() const {
  return collapsed_removed + duplicates_removed + vertices_joined + triangles_turned + shells_turned + edges_stitched +
             holes_filled + triangles_added + scraps_removed >
         0;
}

std::vector<std::string> RepairSummary::sentences() const {
  std::vector<std::string> all;
  add_count(all, collapsed_removed, "triangle without three vertices left out",
            "triangles without three vertices left out");
  add_count(all, duplicates_removed, "triangle left out that lies on another", "triangles left out that lie on others");
  add_count(all, vertices_joined, "vertex of an open edge joined with its neighbour",
            "vertices of open edges joined with their neighbours");
  add_count(all, edges_stitched, "pair of open edges at the same place stitched",
            "pairs of open edges at the same place stitched");
  add_count(all, holes_filled, "hole filled", "holes filled");
  add_count(all, triangles_added, "triangle added for it", "triangles added for them");
  add_count(all, scraps_removed, "open piece left out that bounds nothing", "open pieces left out that bound nothing");
  add_count(all, triangles_turned, "triangle turned to agree with its neighbours",
            "triangles turned to agree with their neighbours");
  add_count(all, shells_turned, "shell turned to face out of the material (in a cavity: into it)",
            "shells turned to face out of the material (in a cavity: into it)");
  if (self_intersections)
    add_count(all, *self_intersections, "pair of triangles crosses; it is left as it is",
              "pairs of triangles cross; they are left as they are");
  return all;
}

RepairedPart repair_part(PartMesh mesh, const RepairOptions& options) {
  require(!mesh.triangles.empty(), "a part without triangles cannot be mended");
  require(options.snap_share >= 0.0 && options.snap_share < 0.1, "snap_share must be from 0 to 0.1");
  RepairedPart part{std::move(mesh), {}};
  RepairSummary& summary = part.summary;
  summary.before = summary.after = mesh_facts(part.mesh);
  if (!is_sound(summary.before)) {
    mend_by_numbers(part.mesh, summary.before, options, summary);
    MeshFacts facts = summary.changed() ? mesh_facts(part.mesh) : summary.before;
    if (part.mesh.triangles.empty()) require_volume(part.mesh, facts);
    if (!facts.closed()) {
      close_surface(part.mesh, options, summary);
      facts = mesh_facts(part.mesh);
      if (!facts.closed()) {
        throw MethodError(fmt::format("the part cannot be closed: {} edges stay open; mend it where it was modelled",
                                      facts.unbalanced_edges));
      }
    }
    summary.shells_turned = face_outwards(part.mesh);
    if (summary.changed()) {
      remove_unused_vertices(part.mesh);
      facts = mesh_facts(part.mesh);
    }
    require_volume(part.mesh, facts);
    summary.after = facts;
  }
  if (summary.changed() || options.count_self_intersections)
    summary.self_intersections = count_self_intersections(part.mesh);
  return part;
}

}  // namespace mezzotint
