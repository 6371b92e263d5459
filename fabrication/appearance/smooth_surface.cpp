#include "fabrication/appearance/smooth_surface.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "fabrication/part/edge_table.h"
#include "forward/base/error.h"

namespace mezzotint {

namespace {

using Eigen::Vector3d;
constexpr double longest_mitre = 3.0;

// Corners of triangles that belong to one node, by union and find; the smaller number is the root.
class CornerGroups {
public:
  explicit CornerGroups(std::size_t corners) : parents_(corners) { std::iota(parents_.begin(), parents_.end(), 0U); }
  std::uint32_t root(std::uint32_t corner) {
    while (parents_[corner] != corner) {
      parents_[corner] = parents_[parents_[corner]];
      corner = parents_[corner];
    }
    return corner;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t p = root(a), q = root(b);
    parents_[std::max(p, q)] = std::min(p, q);
  }

private:
  std::vector<std::uint32_t> parents_;
};

std::size_t corner_at(const SmoothSurface& surface, std::uint32_t triangle, std::uint32_t vertex) {
  const auto& corners = surface.corners[triangle];
  return static_cast<std::size_t>(std::ranges::find(corners, vertex) - corners.begin());
}

Vector3d face_normal(const SmoothSurface& surface, std::size_t triangle) {
  const auto& [a, b, c] = surface.corners[triangle];
  const auto& at = surface.vertices_mm;
  return (at[b] - at[a]).cross(at[c] - at[a]).stableNormalized();
}

// The shortest vector with n·m = 1 for all the normals, as far as there is one.
Vector3d mitre(std::span<const Vector3d> normals) {
  if (normals.size() == 1) return normals[0];
  Eigen::Matrix3d squares = 1e-6 * Eigen::Matrix3d::Identity();
  Vector3d sum = Vector3d::Zero();
  for (const Vector3d& n : normals) {
    squares += n * n.transpose();
    sum += n;
  }
  const Vector3d vector = squares.inverse() * sum;
  const double length = vector.norm();
  return length > longest_mitre ? Vector3d(vector * (longest_mitre / length)) : vector;
}

struct SurfaceBuilder {
  SmoothSurface surface;
  CornerGroups groups;
  std::vector<Vector3d> face_normals;
  double least_cosine;
  // The triangles at the creases, in their order.
  std::vector<std::vector<std::uint32_t>> crease_triangles;
  std::vector<std::array<std::uint32_t, 2>> crease_ends;

  SurfaceBuilder(const PartMesh& mesh, Angle crease_angle)
      : groups(3 * mesh.triangles.size()), least_cosine(std::cos(crease_angle.radians())) {
    for (const auto& p : mesh.vertices_mm) surface.vertices_mm.emplace_back(p[0], p[1], p[2]);
    surface.corners = mesh.triangles;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) face_normals.push_back(face_normal(surface, t));
    surface.sides.assign(mesh.triangles.size(), {SmoothSurface::none, SmoothSurface::none, SmoothSurface::none});
    surface.sources.resize(mesh.triangles.size());
    std::iota(surface.sources.begin(), surface.sources.end(), 0U);
    surface.owners.assign(mesh.vertices_mm.size(), SmoothSurface::none);
  }

  void add_edge(std::uint32_t low, std::span<const EdgeTable::Side> sides) {
    const std::uint32_t high = sides[0].high;
    const bool pair = sides.size() == 2 && sides[0].walks_down() != sides[1].walks_down();
    const bool smooth = pair && face_normals[sides[0].number()].dot(face_normals[sides[1].number()]) > least_cosine;
    if (smooth) {
      for (const std::uint32_t vertex : {low, high}) {
        const auto corner = [&](std::size_t side) {
          const std::uint32_t triangle = sides[side].number();
          return 3 * triangle + static_cast<std::uint32_t>(corner_at(surface, triangle, vertex));
        };
        groups.join(corner(0), corner(1));
      }
    } else {
      std::vector<std::uint32_t> triangles;
      for (const auto& side : sides) triangles.push_back(side.number());
      crease_triangles.push_back(std::move(triangles));
      crease_ends.push_back({low, high});
    }
    const auto crease = static_cast<std::uint32_t>(crease_triangles.size() - 1);
    for (const auto& side : sides) {
      const std::size_t k = corner_at(surface, side.number(), side.walks_down() ? high : low);
      surface.sides[side.number()].at(k) = static_cast<std::uint32_t>(surface.edges.size());
    }
    surface.edges.push_back({sides[0].number(), smooth ? SmoothSurface::none : crease});
  }

  void make_nodes() {
    std::vector<std::uint32_t> node_of_root(3 * surface.corners.size(), SmoothSurface::none);
    surface.nodes.resize(surface.corners.size());
    for (std::uint32_t t = 0; t < surface.corners.size(); ++t) {
      for (std::uint32_t k = 0; k < 3; ++k) {
        std::uint32_t& node = node_of_root[groups.root(3 * t + k)];
        const std::uint32_t vertex = surface.corners[t].at(k);
        if (node == SmoothSurface::none) {
          node = static_cast<std::uint32_t>(surface.normals.size());
          surface.normals.emplace_back(Vector3d::Zero());
          surface.node_vertices.push_back(vertex);
        }
        surface.nodes[t].at(k) = node;
        surface.normals[node] += angle_at(t, k) * face_normals[t];
        surface.owners[vertex] = std::min(surface.owners[vertex], t);
      }
    }
    for (std::size_t t = 0; t < surface.corners.size(); ++t)
      for (const std::uint32_t node : surface.nodes[t])
        if (surface.normals[node].squaredNorm() < 1e-12) surface.normals[node] = face_normals[t];
    // A node of nothing but triangles without area has no normal of its own, and moves nothing that counts.
    for (Vector3d& normal : surface.normals)
      normal = normal.squaredNorm() > 0.0 ? Vector3d(normal.normalized()) : Vector3d(Vector3d::UnitZ());
  }

  [[nodiscard]] double angle_at(std::uint32_t t, std::uint32_t k) const {
    const auto& corners = surface.corners[t];
    const Vector3d& at = surface.vertices_mm[corners.at(k)];
    const Vector3d a = surface.vertices_mm[corners.at((k + 1) % 3)] - at,
                   b = surface.vertices_mm[corners.at((k + 2) % 3)] - at;
    return std::atan2(a.cross(b).norm(), a.dot(b));
  }

  void make_offsets() {
    std::vector<std::vector<Vector3d>> around(surface.vertices_mm.size());
    for (std::size_t node = 0; node < surface.normals.size(); ++node)
      around[surface.node_vertices[node]].push_back(surface.normals[node]);
    for (const auto& normals : around) {
      surface.offsets.push_back(normals.empty() ? Vector3d::Zero() : mitre(normals));
      surface.on_crease.push_back(normals.size() > 1 ? 1 : 0);
    }
    for (std::size_t i = 0; i < crease_triangles.size(); ++i) {
      std::array<std::vector<Vector3d>, 2> normals;
      for (std::size_t end = 0; end < 2; ++end) {
        for (const std::uint32_t t : crease_triangles[i])
          normals.at(end).push_back(
              surface.normals[surface.nodes[t].at(corner_at(surface, t, crease_ends[i].at(end)))]);
      }
      surface.creases.push_back({mitre(normals[0]), mitre(normals[1])});
    }
  }
};

}  // namespace

SmoothSurface smooth_surface(const PartMesh& mesh, Angle crease_angle) {
  require(crease_angle >= 1.0_deg && crease_angle <= 180.0_deg, "a crease angle lies within 1 and 180 degrees");
  const EdgeTable edges(mesh);
  SurfaceBuilder builder(mesh, crease_angle);
  edges.for_each_edge(
      [&builder](std::uint32_t low, std::span<const EdgeTable::Side> sides) { builder.add_edge(low, sides); });
  builder.make_nodes();
  builder.make_offsets();
  return std::move(builder.surface);
}

}  // namespace mezzotint
