#pragma once

#include <memory>
#include <optional>

#include "forward/scattering/path_tracing.h"
#include "forward/surface/mesh.h"
#include "forward/tracing/mesh_scene.h"

namespace mezzotint {

/// The BSDF of a triangle mesh by path tracing: for surfaces that no height field can hold, as overhangs. The same
/// paths, weights and statistics as PathTracer, without its splat; the facets are found by Embree (see MeshScene).
///
/// Ends     a mesh with a period repeats. One without is a patch: rays are aimed at its inner part, so that they and
///          what they meet next stay on it; the guard band around is as wide as the mesh is high × (1 + tanθ), at most
///          a quarter of its length. What misses it, or leaves beside it, is `left_sideways`, and no part of the maps.
/// Sides    a face is met from outside only on its front. The share of first hits that would be from behind stands as
///          "from_behind_share" in the provenance; such light is lost ("leaked_share"). A patch, not a solid: light
///          inside leaves below the lowest point.
/// Errors   InvalidInput as PathTracer and MeshScene; for interpolated normals, the slides' estimator and the control
///          variate, which a mesh does not have; where most first hits would be from behind. Else as PathTracer.
/// Bits     the same for the same options and mesh with any number of threads.
class MeshPathTracer {
public:
  explicit MeshPathTracer(const TriangleMesh& mesh, const std::optional<MeshPeriod>& period = {});

  /// `options.tracer` does not matter.
  [[nodiscard]] Bsdf trace(const PathTracingOptions& options, const Progress& progress = {}) const;

private:
  std::size_t triangles_;
  std::string digest_;
  MeshScene scene_;
};

}  // namespace mezzotint
