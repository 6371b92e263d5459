#pragma once

#include "forward/tracing/height_pyramid.h"
#include "forward/tracing/relief_tracer.h"

namespace mezzotint {

/// Rays through a periodic height field, many at once: up and down a pyramid of highest (from below: lowest) heights,
/// then cell by cell; rays that need the same thing next share a vector.
///
/// Facets   the same two triangles a cell as PeriodicTile. Met where a ray goes from their front to their back.
/// Edges    watertight without an epsilon: a ray that has left a facet moves away from it, and one that rounding
///          took below a facet at an edge meets it there.
/// Ends     periodic; a ray that crosses more than `most_tiles` tiles is Lost (it runs level between the crests).
/// Memory   up to 12 bytes a cell of the tile (both pyramids and the samples), plus address space for the gaps.
/// Bits     the same for every SIMD target and batch size: no fused operations.
/// Source   Tevs, Ihrke, Seidel, "Maximum mipmaps for fast, accurate, and scalable dynamic height field rendering",
///          I3D 2008; the leaf test is our own.
class HeightFieldTracer final : public ReliefTracer {
public:
  explicit HeightFieldTracer(const PeriodicTile& tile) : pyramid_(tile) {}

  void closest_hits(const RayBatch& rays, std::size_t count, HitBatch& hits) const override;
  [[nodiscard]] const HeightPyramid& pyramid() const { return pyramid_; }

  static constexpr std::int32_t most_tiles = 100000;

private:
  HeightPyramid pyramid_;
};

}  // namespace mezzotint
