#pragma once

#include <cstddef>
#include <vector>

#include "forward/optics/direction_map.h"
#include "forward/optics/material.h"
#include "forward/scattering/path_tracing.h"
#include "forward/tracing/periodic_tile.h"
#include "forward/tracing/ray_batch.h"

namespace mezzotint {

/// What the surface does with the rays that meet it, in the order of their hits.
///
/// Frame    directions are unit vectors, the way the light travels; `normal_*` is the one that was used, upwards.
/// Missing  entries of rays that did not meet the surface mean nothing. `refracted` is set where `refracts`;
///          otherwise the rest is absorbed.
struct InteractionBatch {
  explicit InteractionBatch(std::size_t capacity) {
    for (auto* part :
         {&reflectance, &reflected_x, &reflected_y, &reflected_z, &refracted_x, &refracted_y, &refracted_z})
      part->resize(capacity + 16);
    refracts.resize(capacity + 16);
    reflected_bin.resize(capacity + 16);
    refracted_bin.resize(capacity + 16);
  }
  std::vector<float> reflectance;
  std::vector<float> reflected_x, reflected_y, reflected_z;
  std::vector<float> refracted_x, refracted_y, refracted_z;
  std::vector<std::uint8_t> refracts;
  std::vector<std::uint32_t> reflected_bin, refracted_bin;  ///< of the map, should nothing stand in the way
  std::uint64_t normal_fallbacks = 0;  ///< interpolated normals that would have sent light through the surface
};

/// About the triangles' normals: single precision, many at a time.
void interact_geometric(const Material& material, const DirectionGrid& grid, const RayBatch& rays, const HitBatch& hits,
                        std::size_t count, InteractionBatch& result);
/// About either kind of normal, in double precision, one after the other. Hits of a mesh have no `tile`, and only
/// geometric normals.
void interact_one_by_one(const PeriodicTile* tile, const Material& material, const DirectionGrid& grid,
                         NormalKind normals, const RayBatch& rays, const HitBatch& hits, std::size_t count,
                         InteractionBatch& result);

}  // namespace mezzotint
