#pragma once

#include <span>

#include "forward/optics/direction.h"
#include "forward/optics/material.h"
#include "forward/surface/slope_covariance.h"
#include "inverse/objective/smooth_grid.h"
#include "inverse/target/lobe_target.h"

namespace mezzotint {

/// The slopes that a lobe speaks of: each bin's light belongs to the facets that mirror it there.
struct ImpliedSlopes {
  double mean_x = 0.0, mean_y = 0.0;  ///< not 0 where a lobe stands beside the mirror direction
  SlopeCovariance covariance;         ///< about the mean; what a soft bin's own width adds is taken off
  double light = 0.0;                 ///< ∫ f cosθ dω
};

/// Method  half vector of the light and the bin's middle; a facet's weight is undone: F·(ω_i·m)/(m_z cosθ_i).
/// Leaves out  shadows and further reflections, which a lobe of steep relief has; a bin's light counts as one slope.
/// @throws InvalidInput for a map of another grid or without light.
[[nodiscard]] ImpliedSlopes implied_slopes(const SmoothGrid& grid, const Material& material,
                                           const DirectionAngles& to_light, std::span<const double> map);

/// The mean over a target's directions of the light, for its own maps or others on the same bins.
[[nodiscard]] ImpliedSlopes implied_slopes(const LobeTarget& target, const std::vector<DirectionMap>& maps);

}  // namespace mezzotint
