#pragma once

#include <vector>

#include "forward/optics/direction_map.h"
#include "forward/optics/material.h"
#include "inverse/design/printed_texture.h"

namespace mezzotint {

/// A lobe that printed surfaces should show: reflection maps for some directions of the light, all by single
/// reflection without shadows (slope_reflection_map), so that what that leaves out is the same on both sides.
struct LobeGoal {
  DirectionGrid grid;
  Material material;
  std::vector<DirectionAngles> incidences;
  std::vector<DirectionMap> maps;  ///< one an incidence
};

/// The goal to look like a relief (a measured scan, levelled and without missing samples).
[[nodiscard]] LobeGoal lobe_goal_of(const HeightField& relief, const Material& material,
                                    const std::vector<DirectionAngles>& incidences, const DirectionGrid& grid);

/// Maps of every draw of a printed texture, in the order of its seeds; one an incidence.
[[nodiscard]] std::vector<std::vector<DirectionMap>> printed_lobes(const PrintedTexture& texture,
                                                                   const Pattern& pattern, GrayLevels levels,
                                                                   const LobeGoal& goal);

/// Cosine-weighted cube-root error of the mean of some draws: √(Σ a (∛f − ∛g)² / Σ a (∛g)²), a = pixel ∩ disc,
/// over all incidences; the cube root keeps a narrow peak from drowning everything else. With a standard
/// error by delete-one jackknife over the draws (NaN for a single one).
[[nodiscard]] Estimate cube_root_error(const std::vector<std::vector<DirectionMap>>& draws, const LobeGoal& goal);

}  // namespace mezzotint
