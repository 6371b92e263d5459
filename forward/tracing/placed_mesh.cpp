#include "forward/tracing/placed_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

// Cells along either side of the tile: a power of two, so that a period is exact in single precision.
constexpr std::uint32_t cells = 1024;
constexpr double most_aspect = 1000.0;
// A periodic mesh must cover its period to this share; what is missing lets light through.
constexpr double coverage_tolerance = 0.01;

struct Box {
  Eigen::Vector3d low, high;
  [[nodiscard]] Eigen::Vector3d size() const { return high - low; }
};

Eigen::Vector3d vertex_um(const TriangleMesh& mesh, std::uint32_t vertex) {
  const auto& place = mesh.vertices_um[vertex];
  return {double{place[0]}, double{place[1]}, double{place[2]}};
}

// Of the vertices that triangles use.
Box box_of(const TriangleMesh& mesh) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Box box{Eigen::Vector3d::Constant(infinity), Eigen::Vector3d::Constant(-infinity)};
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle) {
      box.low = box.low.cwiseMin(vertex_um(mesh, vertex));
      box.high = box.high.cwiseMax(vertex_um(mesh, vertex));
    }
  }
  return box;
}

void require_patch(const Box& box) {
  const Eigen::Vector3d size = box.size();
  require(size.x() > 0.0 && size.y() > 0.0, "the mesh has no extent in x or y; a patch lies along the xy-plane");
  require(
      size.z() <= most_aspect * std::min(size.x(), size.y()) &&
          std::max(size.x(), size.y()) <= most_aspect * std::min(size.x(), size.y()),
      fmt::format("a mesh of {:.4g} × {:.4g} × {:.4g} µm is no patch: one side is more than a thousand times another",
                  size.x(), size.y(), size.z()));
}

void require_period(const Box& box, const MeshPeriod& period) {
  const Eigen::Vector3d size = box.size();
  const double x = period.x.um(), y = period.y.um();
  require(x > 0.0 && y > 0.0 && std::isfinite(x) && std::isfinite(y), "a period must be positive");
  require(size.x() < 2.0 * x && size.y() < 2.0 * y && size.x() > 0.5 * x && size.y() > 0.5 * y,
          fmt::format("a mesh of {:.6g} × {:.6g} µm does not fit a period of {:.6g} × {:.6g} µm", size.x(), size.y(), x,
                      y));
}

struct SeenFromAbove {
  double area = 0.0;    // of faces that look up, minus that of those that look down
  double whole = 0.0;   // both added
  double height = 0.0;  // ∫ z dA_z
};

SeenFromAbove seen_from_above(const PlacedMesh& mesh) {
  SeenFromAbove seen;
  for (std::uint32_t k = 0; k < mesh.triangles.size(); ++k) {
    const Eigen::Vector3d a = mesh.corner(k, 0), b = mesh.corner(k, 1), c = mesh.corner(k, 2);
    const double area = 0.5 * (b - a).cross(c - a).z();
    seen.area += area;
    seen.whole += std::abs(area);
    seen.height += area * (a.z() + b.z() + c.z()) / 3.0;
  }
  return seen;
}

void require_upwards(const SeenFromAbove& seen) {
  require(
      seen.area > -1e-6 * seen.whole,
      "seen from above the mesh shows its back: is it oriented outwards, with z out of the material? Turn its faces "
      "round");
}

void require_whole_period(const SeenFromAbove& seen, double period_area, const MeshPeriod& period) {
  const double share = seen.area / period_area;
  require(
      std::abs(share - 1.0) <= coverage_tolerance,
      fmt::format("seen from above the mesh covers {:.4g} % of its period of {:.6g} × {:.6g} µm; it must close at its "
                  "ends, where the next copy begins",
                  100.0 * share, period.x.um(), period.y.um()));
}

}  // namespace

Eigen::Vector3d PlacedMesh::point(std::uint32_t triangle, double u, double v) const {
  const Eigen::Vector3d first = corner(triangle, 0);
  return first + u * (corner(triangle, 1) - first) + v * (corner(triangle, 2) - first);
}

Direction PlacedMesh::normal(std::uint32_t triangle) const {
  const Eigen::Vector3d first = corner(triangle, 0);
  return (corner(triangle, 1) - first).cross(corner(triangle, 2) - first).normalized();
}

PlacedMesh place_mesh(const TriangleMesh& mesh, const std::optional<MeshPeriod>& period) {
  require(!mesh.triangles.empty(), "the mesh has no triangle");
  const Box box = box_of(mesh);
  require_patch(box);
  if (period) require_period(box, *period);
  const double length_x = period ? period->x.um() : box.size().x(), length_y = period ? period->y.um() : box.size().y();
  PlacedMesh placed;
  SceneFrame& frame = placed.frame;
  frame = {.columns = cells, .rows = cells, .aimed_columns = cells, .aimed_rows = cells};
  frame.unit_um = length_x / cells;
  frame.cell_y = static_cast<float>(length_y / length_x);
  frame.ends = period ? SceneEnds::Periodic : SceneEnds::Open;
  placed.half_x = 0.5 * cells;
  placed.half_y = 0.5 * cells * frame.cell_y;
  placed.reach_x = 0.5 * box.size().x() / frame.unit_um;
  placed.reach_y = 0.5 * box.size().y() / frame.unit_um;
  frame.highest = 0.5 * box.size().z() / frame.unit_um;
  frame.lowest = -frame.highest;
  const Eigen::Vector3d centre = 0.5 * (box.low + box.high);
  placed.vertices.reserve(mesh.vertices_um.size() + 1);
  for (std::uint32_t k = 0; k < mesh.vertices_um.size(); ++k) {
    const Eigen::Vector3d at = (vertex_um(mesh, k) - centre) / frame.unit_um;
    placed.vertices.push_back({static_cast<float>(at.x()), static_cast<float>(at.y()), static_cast<float>(at.z())});
  }
  placed.vertices.push_back({});
  placed.triangles = mesh.triangles;
  const SeenFromAbove seen = seen_from_above(placed);
  require_upwards(seen);
  if (period) require_whole_period(seen, 4.0 * placed.half_x * placed.half_y, *period);
  // A closed body covers nothing on balance; its middle will do.
  if (seen.area > 1e-6 * seen.whole) frame.mean = std::clamp(seen.height / seen.area, frame.lowest, frame.highest);
  return placed;
}

}  // namespace mezzotint
