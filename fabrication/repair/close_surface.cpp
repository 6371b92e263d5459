#include "fabrication/repair/close_surface.h"

#include <algorithm>
#include <array>
#include <exception>
#include <string>
#include <vector>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>
#include <fmt/format.h>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
using Surface = CGAL::Surface_mesh<Point>;
using Halfedge = Surface::Halfedge_index;
using Face = Surface::Face_index;

// A hole's filling is smaller than this share of the piece about it.
constexpr double largest_filling = 0.5;

double area_of(const Surface& surface, Face face) {
  std::array<Point, 3> corners;
  std::size_t k = 0;
  for (const auto vertex : CGAL::vertices_around_face(surface.halfedge(face), surface))
    corners[k++] = surface.point(vertex);
  return std::sqrt(CGAL::squared_area(corners[0], corners[1], corners[2]));
}

Surface surface_of(const PartMesh& mesh) {
  std::vector<Point> points;
  points.reserve(mesh.vertices_mm.size());
  for (const auto& vertex : mesh.vertices_mm) points.emplace_back(vertex[0], vertex[1], vertex[2]);
  std::vector<std::vector<std::size_t>> polygons;
  polygons.reserve(mesh.triangles.size());
  for (const auto& triangle : mesh.triangles) polygons.push_back({triangle[0], triangle[1], triangle[2]});
  pmp::orient_polygon_soup(points, polygons);  // splits what is not manifold; keeps the order
  if (!pmp::is_polygon_soup_a_polygon_mesh(polygons))
    throw MethodError("the part's triangles meet in a way that makes no surface; mend it where it was modelled");
  Surface surface;
  pmp::polygon_soup_to_polygon_mesh(points, polygons, surface);
  return surface;
}

/// A piece of the surface, and what its holes take.
struct Piece {
  double area = 0.0, filled = 0.0;
  std::size_t holes = 0, added = 0;
  bool has_long_hole = false;
};

/// Fills the holes of a surface and takes away the pieces that are sheets.
class Closing {
public:
  Closing(Surface& surface, const RepairOptions& options) : surface_(surface), options_(options) {
    piece_of_ = surface_.add_property_map<Face, std::size_t>("f:piece", 0).first;
    pieces_.resize(pmp::connected_components(surface_, piece_of_));
    for (const Face face : surface_.faces()) pieces_[piece_of_[face]].area += area_of(surface_, face);
  }

  void fill_holes() {
    std::vector<Halfedge> holes;
    pmp::extract_boundary_cycles(surface_, std::back_inserter(holes));
    for (const Halfedge hole : holes) fill(hole);
  }

  void count(RepairSummary& summary) const {
    for (const Piece& piece : pieces_) {
      if (is_scrap(piece)) {
        ++summary.scraps_removed;
        continue;
      }
      summary.holes_filled += piece.holes;
      summary.triangles_added += piece.added;
    }
  }

  /// Removes the scraps; false where nothing is left.
  bool remove_scraps() {
    for (const Face face : surface_.faces())
      if (is_scrap(pieces_[piece_of_[face]])) CGAL::Euler::remove_face(surface_.halfedge(face), surface_);
    return surface_.number_of_faces() > 0;
  }

  [[nodiscard]] bool has_long_hole() const {
    return std::any_of(pieces_.begin(), pieces_.end(), [](const Piece& piece) { return piece.has_long_hole; });
  }

private:
  // Open pieces that are flat or that a lid as large as they would have to close.
  [[nodiscard]] static bool is_scrap(const Piece& piece) {
    return !piece.has_long_hole && piece.holes > 0 && !(piece.filled <= largest_filling * piece.area);
  }

  void fill(Halfedge hole) {
    Piece& piece = pieces_[piece_of_[surface_.face(surface_.opposite(hole))]];
    std::size_t edges = 0;
    for (const Halfedge edge : CGAL::halfedges_around_face(hole, surface_)) edges += edge.is_valid() ? 1 : 0;
    if (edges > options_.longest_hole) {
      piece.has_long_hole = true;
      return;
    }
    std::vector<Face> filling;
    const std::size_t number = piece_of_[surface_.face(surface_.opposite(hole))];
    pmp::triangulate_hole(surface_, hole, std::back_inserter(filling));
    ++piece.holes;
    piece.added += filling.size();
    for (const Face face : filling) {
      piece_of_[face] = number;
      piece.filled += area_of(surface_, face);
    }
  }

  Surface& surface_;
  const RepairOptions& options_;
  Surface::Property_map<Face, std::size_t> piece_of_;
  std::vector<Piece> pieces_;
};

// Faces keep the numbers of their triangles; those that were added come after.
PartMesh part_of(const Surface& surface, const PartMesh& before) {
  PartMesh mesh{.group_names = before.group_names};
  std::vector<std::uint32_t> numbers(surface.num_vertices());
  for (const auto vertex : surface.vertices()) {
    numbers[vertex.idx()] = static_cast<std::uint32_t>(mesh.vertices_mm.size());
    const Point& point = surface.point(vertex);
    mesh.vertices_mm.push_back({point.x(), point.y(), point.z()});
  }
  const auto filled = static_cast<std::uint32_t>(before.group_names.size());
  bool any_filled = false;
  for (const Face face : surface.faces()) {
    std::array<std::uint32_t, 3> corners{};
    std::size_t k = 0;
    for (const auto vertex : CGAL::vertices_around_face(surface.halfedge(face), surface))
      corners[k++] = numbers[vertex.idx()];
    mesh.triangles.push_back(corners);
    if (before.groups.empty()) continue;
    const bool was_there = face.idx() < before.groups.size();
    mesh.groups.push_back(was_there ? before.groups[face.idx()] : filled);
    any_filled = any_filled || !was_there;
  }
  if (any_filled) mesh.group_names.emplace_back("filled");
  return mesh;
}

void close(PartMesh& mesh, const RepairOptions& options, RepairSummary& summary) {
  Surface surface = surface_of(mesh);
  summary.edges_stitched += pmp::stitch_borders(surface);
  Closing closing(surface, options);
  closing.fill_holes();
  closing.count(summary);
  if (closing.has_long_hole()) {
    throw MethodError(fmt::format(
        "the part has a hole of more than {} edges, too long to guess a surface across it; close it where it was "
        "modelled",
        options.longest_hole));
  }
  if (!closing.remove_scraps()) {
    throw MethodError(
        "the part has no closed body, and none that filling holes would close: its pieces are flat or open sheets; "
        "give "
        "it a thickness where it was modelled");
  }
  mesh = part_of(surface, mesh);
}

}  // namespace

void close_surface(PartMesh& mesh, const RepairOptions& options, RepairSummary& summary) {
  try {
    close(mesh, options, summary);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw MethodError(std::string("CGAL cannot mend the part: ") + error.what());
  }
}

}  // namespace mezzotint
