#pragma once

#include <cstdint>

namespace mezzotint {

/// What lies beyond the ends of a scene.
enum class SceneEnds : std::uint8_t {
  Periodic,  ///< the tile repeats
  Mirrored,  ///< copies that only shadow; they are part of the tile
  Open       ///< nothing: light that goes there is lost from sight
};

/// What following light needs to know of a scene, whatever finds its facets.
///
/// Frame    the tile's cells: x from 0 to `columns`, y from 0 to `rows`, where a patch may be left; z = 0 half-way
///          between the lowest and the highest point.
/// Units    cells of pitch_x for x and z, cells of pitch_y for y.
struct SceneFrame {
  std::uint32_t columns = 0, rows = 0;
  double cell_y = 1.0;  ///< pitch_y / pitch_x
  double unit_um = 1.0;
  double highest = 0.0, lowest = 0.0;
  double mean = 0.0;  ///< the macrosurface, at which rays are aimed
  SceneEnds ends = SceneEnds::Periodic;
  /// The part of the macrosurface at which rays are aimed: its corner and its size.
  double aimed_x = 0.0, aimed_y = 0.0, aimed_columns = 0.0, aimed_rows = 0.0;
};

}  // namespace mezzotint
