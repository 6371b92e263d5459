#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "fabrication/part/part_mesh.h"
#include "fabrication/slicing/raster_triangle.h"

namespace mezzotint::test {

using Outline = std::vector<std::array<double, 2>>;

/// The part of an outline on one side of a line: coordinate `axis` ≥ value for side 1, ≤ value for −1. Four cuts leave
/// what lies in a pixel, independent of the rasteriser.
inline Outline cut_by(const Outline& outline, std::size_t axis, double value, double side) {
  Outline kept;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const auto& a = outline[i];
    const auto& b = outline[(i + 1) % outline.size()];
    const double da = side * (a[axis] - value), db = side * (b[axis] - value);
    if (da >= 0.0) kept.push_back(a);
    if (da * db < 0.0) kept.push_back({a[0] + da / (da - db) * (b[0] - a[0]), a[1] + da / (da - db) * (b[1] - a[1])});
  }
  return kept;
}

/// A regular polygon, counter-clockwise: a disc where it has many corners.
inline Outline disc(double x, double y, double radius, std::size_t corners, double phase = 0.0) {
  Outline outline;
  for (std::size_t i = 0; i < corners; ++i) {
    const double angle = phase + 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(corners);
    outline.push_back({x + radius * std::cos(angle), y + radius * std::sin(angle)});
  }
  return outline;
}

/// A wheel with trapezoidal teeth: not convex, but seen whole from its middle.
inline Outline gear(double x, double y, double inner, double outer, std::size_t teeth, double phase = 0.0) {
  Outline outline;
  const double step = 2.0 * std::numbers::pi / static_cast<double>(teeth);
  for (std::size_t i = 0; i < teeth; ++i) {
    const std::array<std::array<double, 2>, 4> corners = {{{0.0, inner}, {0.3, inner}, {0.4, outer}, {0.9, outer}}};
    for (const auto& [at, radius] : corners) {
      const double angle = phase + (static_cast<double>(i) + at) * step;
      outline.push_back({x + radius * std::cos(angle), y + radius * std::sin(angle)});
    }
  }
  return outline;
}

inline double area(const Outline& outline) {
  double twice = 0.0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const auto& a = outline[i];
    const auto& b = outline[(i + 1) % outline.size()];
    twice += a[0] * b[1] - a[1] * b[0];
  }
  return 0.5 * twice;
}

/// The outline drawn out from z = bottom to z = top; its flat ends are fans from the corners' mean.
inline PartMesh prism(const Outline& outline, double bottom, double top) {
  PartMesh mesh;
  const auto count = static_cast<std::uint32_t>(outline.size());
  std::array<double, 2> middle = {0.0, 0.0};
  for (const auto& corner : outline) {
    mesh.vertices_mm.push_back({corner[0], corner[1], bottom});
    middle[0] += corner[0] / count;
    middle[1] += corner[1] / count;
  }
  for (const auto& corner : outline) mesh.vertices_mm.push_back({corner[0], corner[1], top});
  mesh.vertices_mm.push_back({middle[0], middle[1], bottom});
  mesh.vertices_mm.push_back({middle[0], middle[1], top});
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t j = (i + 1) % count;
    mesh.triangles.push_back({i, j, count + j});
    mesh.triangles.push_back({i, count + j, count + i});
    mesh.triangles.push_back({2 * count, j, i});
    mesh.triangles.push_back({2 * count + 1, count + i, count + j});
  }
  return mesh;
}

inline PartMesh box(std::array<double, 3> low, std::array<double, 3> high) {
  return prism({{low[0], low[1]}, {high[0], low[1]}, {high[0], high[1]}, {low[0], high[1]}}, low[2], high[2]);
}

/// Rings of latitude; flat where a real sphere is round, which its own volume knows.
inline PartMesh sphere(std::array<double, 3> middle, double radius, std::uint32_t rings, std::uint32_t sectors) {
  PartMesh mesh;
  mesh.vertices_mm.push_back({middle[0], middle[1], middle[2] - radius});
  for (std::uint32_t ring = 1; ring < rings; ++ring) {
    const double polar = std::numbers::pi * (static_cast<double>(ring) / rings - 0.5);
    for (const auto& p : disc(middle[0], middle[1], radius * std::cos(polar), sectors))
      mesh.vertices_mm.push_back({p[0], p[1], middle[2] + radius * std::sin(polar)});
  }
  const auto last = static_cast<std::uint32_t>(mesh.vertices_mm.size());
  mesh.vertices_mm.push_back({middle[0], middle[1], middle[2] + radius});
  for (std::uint32_t s = 0; s < sectors; ++s) {
    const std::uint32_t t = (s + 1) % sectors;
    mesh.triangles.push_back({0, 1 + t, 1 + s});
    for (std::uint32_t ring = 0; ring + 2 < rings; ++ring) {
      const std::uint32_t low = 1 + ring * sectors, high = low + sectors;
      mesh.triangles.push_back({low + s, low + t, high + t});
      mesh.triangles.push_back({low + s, high + t, high + s});
    }
    mesh.triangles.push_back({last, last - sectors + s, last - sectors + t});
  }
  return mesh;
}

/// A plate from z = 0 up to heights[row][column] over a grid of `step`: two triangles a cell, walls and a floor.
inline PartMesh plate(const std::vector<std::vector<double>>& heights, double step) {
  PartMesh mesh;
  const auto rows = static_cast<std::uint32_t>(heights.size());
  const auto columns = static_cast<std::uint32_t>(heights[0].size());
  for (const bool top : {false, true}) {
    for (std::uint32_t r = 0; r < rows; ++r) {
      for (std::uint32_t c = 0; c < columns; ++c)
        mesh.vertices_mm.push_back({c * step, r * step, top ? heights[r][c] : 0.0});
    }
  }
  const std::uint32_t up = rows * columns;
  const auto at = [columns](std::uint32_t r, std::uint32_t c) { return r * columns + c; };
  for (std::uint32_t r = 0; r + 1 < rows; ++r) {
    for (std::uint32_t c = 0; c + 1 < columns; ++c) {
      const std::uint32_t a = at(r, c), b = at(r, c + 1), d = at(r + 1, c), e = at(r + 1, c + 1);
      mesh.triangles.push_back({up + a, up + b, up + e});
      mesh.triangles.push_back({up + a, up + e, up + d});
      mesh.triangles.push_back({a, e, b});
      mesh.triangles.push_back({a, d, e});
    }
  }
  const auto wall = [&](std::uint32_t a, std::uint32_t b) {
    mesh.triangles.push_back({a, b, up + b});
    mesh.triangles.push_back({a, up + b, up + a});
  };
  for (std::uint32_t c = 0; c + 1 < columns; ++c) {
    wall(at(0, c), at(0, c + 1));
    wall(at(rows - 1, c + 1), at(rows - 1, c));
  }
  for (std::uint32_t r = 0; r + 1 < rows; ++r) {
    wall(at(r, columns - 1), at(r + 1, columns - 1));
    wall(at(r + 1, 0), at(r, 0));
  }
  return mesh;
}

/// By the divergence theorem.
inline double volume(const PartMesh& mesh) {
  double six = 0.0;
  for (const auto& [i, j, k] : mesh.triangles) {
    const auto &a = mesh.vertices_mm[i], &b = mesh.vertices_mm[j], &c = mesh.vertices_mm[k];
    six += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return six / 6.0;
}

/// One millimetre a pixel and a layer.
inline std::vector<RasterTriangle> as_triangles(const PartMesh& mesh, std::array<double, 3> shift = {0.0, 0.0, 0.0}) {
  std::vector<RasterTriangle> triangles;
  for (const auto& corners : mesh.triangles) {
    RasterTriangle triangle;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& p = mesh.vertices_mm[corners[i]];
      triangle[i] = {p[0] + shift[0], p[1] + shift[1], p[2] + shift[2]};
    }
    triangles.push_back(triangle);
  }
  return triangles;
}

}  // namespace mezzotint::test
