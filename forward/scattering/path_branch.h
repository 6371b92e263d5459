#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "forward/tracing/ray_batch.h"

namespace mezzotint {

struct PathBatch;

/// One of the two ways that light takes at the first hits, many at a time.
struct FirstBranch {
  const std::vector<float>&x, &y, &z;     ///< where it goes
  const std::vector<std::uint32_t>& bin;  ///< of the map, should nothing stand in the way
  const std::vector<float>& weight;       ///< 0: nothing goes there
  Side side;
  std::uint8_t number;  ///< 0 reflected, 1 refracted
};

/// Appends the paths that go on from the first `count` hits by one branch, in their order; path k of them is number
/// `first_number` + k of the run.
void push_branch(const HitBatch& hits, const FirstBranch& branch, std::uint64_t first_number, std::size_t count,
                 PathBatch& next);

/// The rays of a batch by where they ended, each list in their order.
struct EndLists {
  explicit EndLists(std::size_t capacity)
      : met_(capacity + 16), reflected_(capacity + 16), transmitted_(capacity + 16), lost_(capacity + 16) {}
  std::span<const std::uint32_t> met, reflected, transmitted;  ///< a facet; out above it, out below it
  std::span<const std::uint32_t> lost;                         ///< through the surface, beside the patch, or nowhere

  void sort(const RayBatch& rays, const HitBatch& hits, std::size_t count);

private:
  std::vector<std::uint32_t> met_, reflected_, transmitted_, lost_;
};

}  // namespace mezzotint
