#pragma once

#include <cstddef>

#include "forward/tracing/ray_batch.h"

namespace mezzotint {

/// What an estimator asks of a tracer. Called by many threads at once.
class ReliefTracer {
public:
  virtual ~ReliefTracer() = default;
  /// For each of the first `count` rays the first facet in front of it that looks at it; `hits` must be as large.
  virtual void closest_hits(const RayBatch& rays, std::size_t count, HitBatch& hits) const = 0;
};

}  // namespace mezzotint
