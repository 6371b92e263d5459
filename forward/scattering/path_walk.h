#pragma once

#include <cstdint>

#include "forward/base/random.h"
#include "forward/scattering/batch_tally.h"
#include "forward/scattering/path_tracing.h"
#include "forward/scattering/periodic_tile.h"
#include "forward/scattering/relief_tracer.h"

namespace mezzotint {

/// Follows light from its first ray to where it ends. Knows nothing of how rays find triangles.
class PathWalker {
public:
  /// All that is given must outlive the walker.
  PathWalker(const PeriodicTile& tile, const ReliefTracer& tracer, const PathTracingOptions& options);

  /// Adds the light of one first ray, of weight 1, to the tally.
  void walk(const Ray& first, std::uint64_t ray_index, BatchTally& tally) const;

private:
  struct Path;
  void follow(Path path, BatchTally& tally) const;
  void end_path(const Path& path, RayEnd end, BatchTally& tally) const;
  void meet_again(Path& path, const SurfaceHit& hit, BatchTally& tally) const;
  [[nodiscard]] bool met_a_copy(const Ray& first, const SurfaceHit& hit) const;
  [[nodiscard]] double choice(const Path& path) const;

  const PeriodicTile& tile_;
  const ReliefTracer& tracer_;
  const PathTracingOptions& options_;
  RandomStream choices_;
};

}  // namespace mezzotint
