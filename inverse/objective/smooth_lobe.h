#pragma once

#include <span>

#include "forward/optics/direction.h"
#include "forward/optics/material.h"
#include "inverse/objective/lobe_kernels.h"
#include "inverse/objective/smooth_grid.h"

namespace mezzotint {

/// The light that the facets of a relief reflect by their slopes alone (as slope_reflection_map), in soft bins, with
/// the slope of any figure of that map toward every height.
///
/// Frame    SmoothGrid, upper hemisphere.
/// Missing  heights are not allowed: a search knows its relief whole.
/// Threads  the same bits with any number of them.
/// Source   f = 1/(N·A_bin) Σ F·max(0, ω_i·m)/(m_z cosθ_i)·B(ω_o) over N facets of equal macro area.
class SmoothLobe {
public:
  /// @throws InvalidInput for light at or below the horizon.
  SmoothLobe(const SmoothGrid& grid, const Material& material, const DirectionAngles& to_light);

  /// @throws InvalidInput without a point, or for a slope that is not finite.
  [[nodiscard]] DirectionMap map(std::span<const float> slopes_x, std::span<const float> slopes_y) const;

  /// By the adjoint: from ∂J/∂f, one a bin, adds `share`·∂J/∂(slope) to `toward_x` and `toward_y`, one a point, for the
  /// cost of about a map.
  void add_slope_derivatives(std::span<const float> slopes_x, std::span<const float> slopes_y,
                             std::span<const double> map_derivatives, double share, std::span<float> toward_x,
                             std::span<float> toward_y) const;

private:
  SmoothGrid grid_;
  LobePlan plan_;
};

}  // namespace mezzotint
