#pragma once

#include "forward/optics/material.h"
#include "forward/scattering/path_tracing.h"
#include "forward/scattering/periodic_tile.h"
#include "forward/scattering/relief_tracer.h"

namespace mezzotint {

/// What the surface does with a ray that meets it.
struct SurfaceInteraction {
  Direction normal;  ///< the one that was used, upwards
  double reflectance = 1.0;
  bool refracts = false;  ///< the rest goes on along `refracted`; otherwise it is absorbed
  Direction reflected;
  Direction refracted;
  bool normal_fell_back = false;  ///< the interpolated normal would have sent light through the surface
};

[[nodiscard]] SurfaceInteraction interact(const PeriodicTile& tile, const Material& material, NormalKind normals,
                                          const Ray& ray, const SurfaceHit& hit);

}  // namespace mezzotint
