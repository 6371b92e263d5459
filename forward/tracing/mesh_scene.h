#pragma once

#include <memory>
#include <optional>

#include "forward/base/units.h"
#include "forward/surface/mesh.h"
#include "forward/tracing/relief_tracer.h"
#include "forward/tracing/scene_frame.h"

namespace mezzotint {

/// How far a mesh is from its next copy.
struct MeshPeriod {
  Length x, y;
};

/// Rays through a triangle mesh by Intel Embree 3: any shape, overhangs included.
///
/// Frame    the macrosurface is z = const; the tile is as large as the period, or as the mesh where it has none, and
///          centred on the mesh. Rays are aimed at its mean height ∫z dA_z/∫dA_z, A_z the area seen from above.
/// Sides    what lies where a face's corners run counter-clockwise is outside. A ray that comes upon the back of a
///          face ends as RayEnd::Behind. A sheet of two faces back to back may have no thickness; a gap must have 2e-4
///          cells (2e-7 of the extent).
/// Ends     with a period the mesh repeats, also where it reaches over the ends of the tile; its ends must fit to
///          each other. Without, a ray that leaves beside the mesh ends as RayEnd::Sideways, and one that passes
///          through a hole as RayEnd::Below.
/// Edges    robust triangle tests: no ray passes between two triangles that share an edge. A ray starts 1e-4 cells
///          (1e-7 of the extent) behind its origin, without the facet that it has left.
/// Errors   InvalidInput for a mesh without triangles or extent, one more than a thousand times as long or high as
///          wide, one that shows mostly its back from above, or that covers its period only in part (to 1 %).
///          DeviceError, MethodError as ReliefScene.
/// Memory   about 120 bytes a triangle.
/// Bits     the same on any number of threads.
class MeshScene final : public ReliefTracer {
public:
  explicit MeshScene(const TriangleMesh& mesh, const std::optional<MeshPeriod>& period = {});
  ~MeshScene() override;
  MeshScene(const MeshScene&) = delete;
  MeshScene& operator=(const MeshScene&) = delete;

  void closest_hits(const RayBatch& rays, std::size_t count, HitBatch& hits) const override;
  [[nodiscard]] const SceneFrame& frame() const;

private:
  struct Parts;
  struct Walk;
  std::unique_ptr<Parts> parts_;
};

}  // namespace mezzotint
