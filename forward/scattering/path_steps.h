#pragma once

#include "forward/scattering/path_walk.h"

/// Inside of forward/scattering: what the walk and the correction of the splat do with one hit.

namespace mezzotint {

enum class Branch { Reflected, Refracted };

/// Light from a facet into the open, whatever stands in its way: the splat.
inline void leave_unhindered(Branch branch, float way_z, std::uint32_t bin, double weight, BatchTally& tally) {
  const bool up = branch == Branch::Reflected;
  if (up ? way_z <= 0.0F : way_z >= 0.0F) return;
  tally.leave(up ? Fate::Reflected : Fate::Transmitted, bin, weight, 1);
}

/// The path that goes on from hit k.
inline void push(const WalkSpace& space, std::size_t k, Branch branch, Side side, float weight, std::uint64_t number,
                 std::uint8_t first_branch, PathBatch& next) {
  const HitBatch& hits = space.hits;
  const InteractionBatch& met = space.met;
  const std::size_t at = next.count++;
  RayBatch& rays = next.rays;
  rays.cell_x[at] = hits.cell_x[k];
  rays.cell_y[at] = hits.cell_y[k];
  rays.x[at] = hits.x[k];
  rays.y[at] = hits.y[k];
  rays.z[at] = hits.z[k];
  const bool reflected = branch == Branch::Reflected;
  rays.dx[at] = reflected ? met.reflected_x[k] : met.refracted_x[k];
  rays.dy[at] = reflected ? met.reflected_y[k] : met.refracted_y[k];
  rays.dz[at] = reflected ? met.reflected_z[k] : met.refracted_z[k];
  rays.side[at] = side;
  rays.left[at] = hits.triangle[k];
  next.weight[at] = weight;
  next.bin[at] = reflected ? met.reflected_bin[k] : met.refracted_bin[k];
  next.number[at] = number;
  next.branch[at] = first_branch;
}

}  // namespace mezzotint
