#include <array>
#include <complex>

#include <Eigen/QR>

#include "fabrication/appearance/direction_field.h"
#include "fabrication/appearance/tangent_plane.h"

namespace mezzotint {

namespace {

using Eigen::Vector3d;

// The second fundamental form of a triangle in the plane (u, v), from how its corners' normals differ: L, M, N.
Vector3d second_form(const SmoothSurface& surface, std::size_t t, const TangentPlane& plane) {
  Eigen::Matrix<double, 6, 3> left;
  Eigen::Matrix<double, 6, 1> right;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    const Vector3d edge =
        surface.vertices_mm[surface.corners[t].at(next)] - surface.vertices_mm[surface.corners[t].at(k)];
    const Vector3d turn = surface.normals[surface.nodes[t].at(next)] - surface.normals[surface.nodes[t].at(k)];
    const auto row = static_cast<Eigen::Index>(2 * k);
    left.row(row) << edge.dot(plane.u), edge.dot(plane.v), 0.0;
    left.row(row + 1) << 0.0, edge.dot(plane.u), edge.dot(plane.v);
    right[row] = turn.dot(plane.u);
    right[row + 1] = turn.dot(plane.v);
  }
  return left.colPivHouseholderQr().solve(right);
}

}  // namespace

std::vector<Vector3d> bending_directions(const SmoothSurface& surface) {
  std::vector<std::complex<double>> lines(surface.normals.size(), 0.0);
  std::vector<double> areas(surface.normals.size(), 0.0);
  for (std::size_t t = 0; t < surface.corners.size(); ++t) {
    const auto& [a, b, c] = surface.corners[t];
    const Vector3d at = surface.vertices_mm[a];
    const Vector3d across = (surface.vertices_mm[b] - at).cross(surface.vertices_mm[c] - at);
    const double area = across.norm();
    if (!(area > 0.0)) continue;
    const Vector3d normal = across / area;
    const TangentPlane plane(normal);
    const Vector3d form = second_form(surface, t, plane);
    // e^(2iα)(k₁ − k₂), α the direction of k₁; of the larger curvature in size.
    std::complex<double> line(form[0] - form[2], 2.0 * form[1]);
    if (form[0] + form[2] < 0.0) line = -line;
    const Vector3d direction = plane.direction(line);
    for (const std::uint32_t node : surface.nodes[t]) {
      const Vector3d there = transported(direction, normal, surface.normals[node]);
      lines[node] += area * std::abs(line) * TangentPlane(surface.normals[node]).line(there);
      areas[node] += area;
    }
  }
  std::vector<Vector3d> directions;
  for (std::size_t node = 0; node < lines.size(); ++node) {
    const std::complex<double> line = areas[node] > 0.0 ? lines[node] / areas[node] : 0.0;
    directions.emplace_back(std::abs(line) * TangentPlane(surface.normals[node]).direction(line));
  }
  return directions;
}

}  // namespace mezzotint
