#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "forward/optics/direction.h"
#include "forward/tracing/mesh_scene.h"

/// Inside of forward/tracing.

namespace mezzotint {

/// A mesh in the frame and units of its scene: cells, centred.
struct PlacedMesh {
  std::vector<std::array<float, 3>> vertices;  ///< and one more, since Embree loads four numbers a vertex
  std::vector<std::array<std::uint32_t, 3>> triangles;
  SceneFrame frame;
  double half_x = 0.0, half_y = 0.0;    ///< of the tile, in cells of pitch_x both
  double reach_x = 0.0, reach_y = 0.0;  ///< of the mesh itself, from the centre
  [[nodiscard]] Eigen::Vector3d corner(std::uint32_t triangle, std::size_t k) const {
    const auto& vertex = vertices[triangles[triangle][k]];
    return {double{vertex[0]}, double{vertex[1]}, double{vertex[2]}};
  }
  /// The point with weights 1 − u − v, u and v of the corners.
  [[nodiscard]] Eigen::Vector3d point(std::uint32_t triangle, double u, double v) const;
  [[nodiscard]] Direction normal(std::uint32_t triangle) const;
};

/// @throws InvalidInput (see MeshScene)
[[nodiscard]] PlacedMesh place_mesh(const TriangleMesh& mesh, const std::optional<MeshPeriod>& period);

}  // namespace mezzotint
