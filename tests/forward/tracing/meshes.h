#pragma once

#include <array>
#include <functional>

#include "forward/surface/mesh.h"

namespace mezzotint::test {

using Point = std::array<double, 3>;

inline void add_triangle(TriangleMesh& mesh, const Point& a, const Point& b, const Point& c) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices_um.size());
  for (const Point& p : {a, b, c})
    mesh.vertices_um.push_back({static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
  mesh.triangles.push_back({first, first + 1, first + 2});
}

/// Corners counter-clockwise seen from its front.
inline void add_quad(TriangleMesh& mesh, const Point& a, const Point& b, const Point& c, const Point& d) {
  add_triangle(mesh, a, b, c);
  add_triangle(mesh, a, c, d);
}

/// A rectangle that looks up, or down.
inline void add_level(TriangleMesh& mesh, double x0, double y0, double x1, double y1, double z, bool up = true) {
  const Point a{x0, y0, z}, b{x1, y0, z}, c{x1, y1, z}, d{x0, y1, z};
  up ? add_quad(mesh, a, b, c, d) : add_quad(mesh, a, d, c, b);
}

/// A profile in (x, z), from left to right, drawn out along y: its front is on the left hand of its way, which is up
/// where it goes to the right.
inline TriangleMesh drawn_out(const std::vector<std::array<double, 2>>& profile, double length_y) {
  TriangleMesh mesh;
  for (std::size_t k = 1; k < profile.size(); ++k) {
    const auto [x0, z0] = profile[k - 1];
    const auto [x1, z1] = profile[k];
    add_quad(mesh, {x0, 0.0, z0}, {x1, 0.0, z1}, {x1, length_y, z1}, {x0, length_y, z0});
  }
  return mesh;
}

/// Moves every vertex.
inline void bend(TriangleMesh& mesh, const std::function<Point(const Point&)>& move) {
  for (auto& vertex : mesh.vertices_um) {
    const Point to = move({double{vertex[0]}, double{vertex[1]}, double{vertex[2]}});
    for (std::size_t axis = 0; axis < 3; ++axis) vertex[axis] = static_cast<float>(to[axis]);
  }
}

inline TriangleMesh turned_round(TriangleMesh mesh) {
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  return mesh;
}

}  // namespace mezzotint::test
