#pragma once

#include <memory>

#include "forward/tracing/periodic_tile.h"
#include "forward/tracing/relief_tracer.h"

namespace mezzotint {

/// Rays through a periodic tile by Intel Embree 3: the tile's triangles and a border of repeated cells.
/// A ray that comes to the border goes on at the other side, as often as needed.
///
/// Errors   DeviceError where Embree cannot start or runs out of memory; MethodError where it cannot filter hits.
/// Bits     the same on any number of threads: of two triangles met at the same distance the first one counts.
class ReliefScene final : public ReliefTracer {
public:
  /// @param tile  must outlive the scene.
  explicit ReliefScene(const PeriodicTile& tile);
  ~ReliefScene() override;
  ReliefScene(const ReliefScene&) = delete;
  ReliefScene& operator=(const ReliefScene&) = delete;

  void closest_hits(const RayBatch& rays, std::size_t count, HitBatch& hits) const override;

private:
  struct Handles;
  struct Walk;
  const PeriodicTile& tile_;
  std::unique_ptr<Handles> handles_;
};

}  // namespace mezzotint
