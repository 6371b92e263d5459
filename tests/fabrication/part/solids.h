#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "fabrication/part/part_mesh.h"

namespace mezzotint::test {

/// A box from `low` to `high`, twelve triangles facing out.
inline PartMesh box(const std::array<double, 3>& low, const std::array<double, 3>& high) {
  PartMesh mesh;
  for (unsigned k = 0; k < 8; ++k)
    mesh.vertices_mm.push_back(
        {(k & 1U) != 0 ? high[0] : low[0], (k & 2U) != 0 ? high[1] : low[1], (k & 4U) != 0 ? high[2] : low[2]});
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

inline PartMesh unit_box() { return box({0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}); }

/// Several meshes in one.
inline PartMesh together(const std::initializer_list<PartMesh>& parts) {
  PartMesh all;
  for (const PartMesh& part : parts) {
    const auto first = static_cast<std::uint32_t>(all.vertices_mm.size());
    all.vertices_mm.insert(all.vertices_mm.end(), part.vertices_mm.begin(), part.vertices_mm.end());
    for (const auto& triangle : part.triangles)
      all.triangles.push_back({triangle[0] + first, triangle[1] + first, triangle[2] + first});
  }
  return all;
}

inline PartMesh inside_out(PartMesh mesh) {
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  return mesh;
}

/// A torus about z: `around` × `across` quadrilaterals, each two triangles.
inline PartMesh torus(double large_radius, double small_radius, std::uint32_t around, std::uint32_t across) {
  PartMesh mesh;
  for (std::uint32_t i = 0; i < around; ++i) {
    for (std::uint32_t j = 0; j < across; ++j) {
      const double u = 2.0 * std::numbers::pi * i / around, v = 2.0 * std::numbers::pi * j / across;
      const double radius = large_radius + small_radius * std::cos(v);
      mesh.vertices_mm.push_back({radius * std::cos(u), radius * std::sin(u), small_radius * std::sin(v)});
      const std::uint32_t a = i * across + j, b = ((i + 1) % around) * across + j;
      const std::uint32_t c = ((i + 1) % around) * across + (j + 1) % across, d = i * across + (j + 1) % across;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  }
  return mesh;
}

}  // namespace mezzotint::test
