#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "fabrication/part/part_mesh.h"

/// Closed parts with known shapes, for tests. Millimetres.

namespace mezzotint {

inline PartMesh box(double x, double y, double z) {
  PartMesh mesh;
  for (int i = 0; i < 8; ++i) mesh.vertices_mm.push_back({i & 1 ? x : 0.0, i & 2 ? y : 0.0, i & 4 ? z : 0.0});
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

/// A sphere about (0, 0, radius), from an octahedron whose edges are halved.
inline PartMesh sphere(double radius, int halvings) {
  PartMesh mesh;
  std::vector<std::array<double, 3>>& at = mesh.vertices_mm;
  at = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int k = 0; k < halvings; ++k) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [place, fresh] = middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(at.size()));
      if (fresh) {
        std::array<double, 3> m{};
        double square = 0.0;
        for (std::size_t i = 0; i < 3; ++i) {
          m.at(i) = at[a].at(i) + at[b].at(i);
          square += m.at(i) * m.at(i);
        }
        for (double& value : m) value /= std::sqrt(square);
        at.push_back(m);
      }
      return place->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const auto& t :
           std::vector<std::array<std::uint32_t, 3>>{{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
        finer.push_back(t);
    }
    mesh.triangles = finer;
  }
  for (auto& p : at) p = {radius * p[0], radius * p[1], radius * p[2] + radius};
  return mesh;
}

/// A cylinder about the z axis, standing on z = 0, with caps.
inline PartMesh cylinder(double radius, double height, std::uint32_t sides, std::uint32_t rings) {
  PartMesh mesh;
  for (std::uint32_t r = 0; r <= rings; ++r) {
    for (std::uint32_t i = 0; i < sides; ++i) {
      const double phi = 2.0 * std::numbers::pi * i / sides;
      mesh.vertices_mm.push_back({radius * std::cos(phi), radius * std::sin(phi), height * r / rings});
    }
  }
  const auto foot = static_cast<std::uint32_t>(mesh.vertices_mm.size()), top = foot + 1;
  mesh.vertices_mm.push_back({0.0, 0.0, 0.0});
  mesh.vertices_mm.push_back({0.0, 0.0, height});
  for (std::uint32_t i = 0; i < sides; ++i) {
    const std::uint32_t j = (i + 1) % sides;
    for (std::uint32_t r = 0; r < rings; ++r) {
      const std::uint32_t low = r * sides, high = low + sides;
      mesh.triangles.push_back({low + i, low + j, high + j});
      mesh.triangles.push_back({low + i, high + j, high + i});
    }
    mesh.triangles.push_back({foot, j, i});
    mesh.triangles.push_back({top, rings * sides + i, rings * sides + j});
  }
  return mesh;
}

/// A torus about the z axis, lying on z = 0.
inline PartMesh torus(double radius, double tube, std::uint32_t around, std::uint32_t across) {
  PartMesh mesh;
  for (std::uint32_t i = 0; i < around; ++i) {
    for (std::uint32_t j = 0; j < across; ++j) {
      const double u = 2.0 * std::numbers::pi * i / around, v = 2.0 * std::numbers::pi * j / across;
      const double r = radius + tube * std::cos(v);
      mesh.vertices_mm.push_back({r * std::cos(u), r * std::sin(u), tube + tube * std::sin(v)});
    }
  }
  const auto at = [&](std::uint32_t i, std::uint32_t j) { return i % around * across + j % across; };
  for (std::uint32_t i = 0; i < around; ++i) {
    for (std::uint32_t j = 0; j < across; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

}  // namespace mezzotint
