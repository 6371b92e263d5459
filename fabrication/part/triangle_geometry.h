#pragma once

#include <array>
#include <cstdint>

#include "fabrication/part/part_mesh.h"

namespace mezzotint {

/// (b − a) × (c − a): along the outward normal, twice the triangle's area long. mm².
[[nodiscard]] inline std::array<double, 3> doubled_area_vector(const PartMesh& mesh,
                                                               const std::array<std::uint32_t, 3>& triangle) {
  const auto& a = mesh.vertices_mm[triangle[0]];
  const auto& b = mesh.vertices_mm[triangle[1]];
  const auto& c = mesh.vertices_mm[triangle[2]];
  const std::array<double, 3> u = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  const std::array<double, 3> v = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

/// Two corners are one vertex: the triangle is a line or a point.
[[nodiscard]] inline bool is_collapsed(const std::array<std::uint32_t, 3>& triangle) {
  return triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0];
}

}  // namespace mezzotint
