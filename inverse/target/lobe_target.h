#pragma once

#include <string>
#include <vector>

#include "forward/optics/direction_map.h"
#include "forward/optics/material.h"
#include "inverse/objective/smooth_grid.h"

namespace mezzotint {

/// Lobes that a printed tile should show: reflection maps in soft bins for some directions of the light, by single
/// reflection without shadows.
struct LobeTarget {
  SmoothGrid grid;
  Material material;
  std::vector<DirectionAngles> incidences;
  std::vector<DirectionMap> maps;  ///< one an incidence
};

/// A goal from maps of hard bins, such as a painted or a measured lobe. With `any_brightness` each map is scaled to the
/// light that a flat surface of the material would reflect: a painting has no unit.
/// @throws InvalidInput for maps that do not fit, or that are dark.
[[nodiscard]] LobeTarget lobe_target(const DirectionGrid& grid, const Material& material,
                                     const std::vector<DirectionAngles>& incidences,
                                     const std::vector<DirectionMap>& maps, bool any_brightness);

/// @param slack  light beyond all that comes in which noise may explain
/// @throws InvalidInput for a goal without directions, of another grid, not finite, negative, dark, or brighter than a
///         mirror.
void require_possible(const LobeTarget& goal, double slack = 1e-6);

/// Of each direction whose light is more than 5 % from what a flat surface of the material reflects: a sentence.
[[nodiscard]] std::vector<std::string> brightness_notes(const LobeTarget& goal);

}  // namespace mezzotint
