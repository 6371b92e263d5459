#pragma once

#include <cstddef>
#include <span>

#include "forward/optics/direction.h"
#include "forward/tracing/beam_front.h"
#include "forward/tracing/scene_frame.h"

namespace mezzotint {

struct AimedRays;

/// One parallel beam.
struct Beam {
  Direction to_light;
  double plane = 0.0;                ///< height of the plane at which its rays aim
  const BeamFront* front = nullptr;  ///< where they start; nullptr: at `top`
  float top = 0.0F;
};

/// Rays of a beam that aim at (aim_x, aim_y), in cells of the tile; into `rays`, from `first` on.
void aim_beam(const SceneFrame& frame, const Beam& beam, std::span<const double> aim_x, std::span<const double> aim_y,
              std::size_t first, AimedRays& rays);

}  // namespace mezzotint
