#pragma once

#include <string>
#include <vector>

#include "experiments/configuration/experiment_file.h"
#include "forward/optics/direction_map.h"

namespace mezzotint {

/// What a target wants, as reflection maps: for `lobe_target` (inverse/target/lobe_target.h).
///
/// Frame    see DirectionGrid; one map a direction of the light.
/// Missing  bins of which nothing was measured hold 0 and have a share of 0 in `measured`.
struct TargetMaps {
  DirectionGrid grid;
  std::vector<DirectionAngles> incidences;
  std::vector<DirectionMap> maps;
  std::vector<DirectionMap> measured;  ///< share of each bin that the target says something of; 1 but for measurements
  /// Only the shape counts: each map is to be scaled to the light that the material reflects (a painting has no unit,
  /// and no relief changes what a material absorbs).
  bool any_brightness = false;
  std::vector<std::string> notes;  ///< what a report should say
};

/// The maps of a target of kind "beckmann", "ggx", "bsdf", "measured" or "image".
///
/// Light    that of [simulation], but for "bsdf", whose files have their own, for "image", which states it, and for a
///          measurement from listed directions where the experiment file leaves `incidence_deg` out.
/// Grid     [simulation] resolution; maps of "bsdf" must have it.
/// @throws InvalidInput with the reason for a target that cannot be: brighter than a mirror, dark, negative beyond
///         noise, not finite; two maps of one direction, maps of different grids; a light that was not measured, or
///         too little of the disc; and for kinds that are no maps. FileError for files that cannot be read.
[[nodiscard]] TargetMaps wanted_maps(const TargetSpecification& target, const SimulationSpecification& simulation);

/// Refuses a reflection map that no surface has. `noise` is a standard error a bin, or empty.
/// @throws InvalidInput that begins with `name` and says at which light, where, and by how much.
void require_possible(const std::string& name, const DirectionAngles& to_light, const DirectionGrid& grid,
                      const DirectionMap& map, const DirectionMap& noise);

}  // namespace mezzotint
