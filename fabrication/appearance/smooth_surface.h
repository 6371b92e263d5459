#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "fabrication/part/part_mesh.h"
#include "forward/base/units.h"

namespace mezzotint {

/// A part's surface as smooth pieces that meet at creases: where normals are continuous and where they jump.
///
/// Node     a vertex as one smooth piece sees it: a vertex on creases has several, each with its own normal (weighted
///          with the angles of the triangles around it, as in Thürmer and Wüthrich 1998).
/// Offset   by which vector a point moves for a displacement of 1 along the normal: the normal itself where the surface
///          is smooth, and at creases the one vector that moves all adjoining faces by 1 (a mitre), at most 3 long.
/// Units    millimetres.
/// Errors   InvalidInput as `EdgeTable`, or for a crease angle outside of 1° … 180°.
struct SmoothSurface {
  static constexpr std::uint32_t none = 0xFFFFFFFFU;
  struct Edge {
    std::uint32_t owner = 0;      ///< the first triangle at it: what is asked about points of the edge is asked there
    std::uint32_t crease = none;  ///< into `creases`; none where the surface is smooth
  };
  /// The offsets at a crease's ends: its vertex of the lower number, and the other.
  struct Crease {
    Eigen::Vector3d low, high;
  };

  std::vector<Eigen::Vector3d> vertices_mm;
  std::vector<Eigen::Vector3d> offsets;               ///< a vertex
  std::vector<std::uint32_t> owners;                  ///< a vertex: the first triangle at it
  std::vector<std::uint8_t> on_crease;                ///< a vertex
  std::vector<std::array<std::uint32_t, 3>> corners;  ///< a triangle's vertices
  std::vector<std::array<std::uint32_t, 3>> nodes;    ///< a triangle's nodes
  std::vector<std::array<std::uint32_t, 3>> sides;    ///< a triangle's edges: from corner k to the next
  std::vector<std::uint32_t> sources;                 ///< a triangle's triangle of the part
  std::vector<Eigen::Vector3d> normals;               ///< a node
  std::vector<std::uint32_t> node_vertices;           ///< a node's vertex
  std::vector<Edge> edges;
  std::vector<Crease> creases;
};

/// @param crease_angle  normals of neighbouring triangles that differ by more make a crease
[[nodiscard]] SmoothSurface smooth_surface(const PartMesh& mesh, Angle crease_angle);

/// The same surface with every edge halved until none is longer than that; new nodes have the mean of their neighbours'
/// normals, so that what was smooth stays smooth.
/// @throws InvalidInput where it would have more than `most_triangles`.
[[nodiscard]] SmoothSurface refined(SmoothSurface surface, Length longest_edge, std::size_t most_triangles);

}  // namespace mezzotint
