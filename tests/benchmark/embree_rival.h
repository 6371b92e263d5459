#pragma once

#include <embree3/rtcore.h>

#include <vector>

#include "forward/tracing/periodic_tile.h"
#include "tests/benchmark/ray_sets.h"

namespace mezzotint::benchmark {

enum class Mesh { Grid, Triangles };
enum class Call { One, Packet, Stream };  ///< rtcIntersect1, rtcIntersect16, rtcIntersect1M of 256 rays

/// Embree at its best, as an opponent: a static scene of one tile, with no filter, no border and no instance, built for
/// speed (not ROBUST); rays come converted and in Morton order, conversion is not counted. Everything that our tracer
/// does and Embree does not speaks for Embree: rays that leave the tile at its side are done, its hits are not brought
/// into our form, and its rays start by `near` off their facet rather than being watertight.
class EmbreeRival {
public:
  EmbreeRival(const PeriodicTile& tile, Mesh mesh);
  ~EmbreeRival();
  EmbreeRival(const EmbreeRival&) = delete;
  EmbreeRival& operator=(const EmbreeRival&) = delete;

  /// Thread CPU time for all rays; `distances`, if given, receives where they hit (infinity: nowhere).
  double seconds(const RaySet& rays, Call call, bool coherent, std::vector<float>* distances = nullptr);

private:
  void fill_vertices(float* vertex) const;
  void fill_triangles(unsigned* corner) const;
  [[nodiscard]] RTCRayHit query(const RayBatch& rays, std::size_t k) const;
  void convert(const RayBatch& rays, Call call);
  void trace(std::size_t count, Call call, RTCIntersectContext& context);

  const PeriodicTile& tile_;
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
  std::vector<RTCRayHit> singles_;
  std::vector<RTCRayHit16> packets_;
};

}  // namespace mezzotint::benchmark
