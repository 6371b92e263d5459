#pragma once

#include <cstdint>
#include <vector>

#include "forward/optics/direction.h"
#include "forward/tracing/periodic_tile.h"

namespace mezzotint {

/// How much of every cell a parallel beam reaches, told without rays: lines along the beam are followed over the
/// relief, one for every row of cells, and each carries the height of the shadow behind the highest crest so far.
///
/// Shape    one value a cell, row after row: 0 dark, 1 half lit, 2 lit.
/// Bound    none: a cell is judged by the two places where a line enters and leaves it, and crests between the grid's
///          lines are missed. At the edges of shadows some cells are judged wrongly (1 % of all at 80° and an RMS
///          gradient of 0.3), so an estimator may assume it but has to correct it.
/// Cost     1 to 2 ns a cell, more where shadows are as long as the tile.
/// Bits     the same with any number of threads.
[[nodiscard]] std::vector<std::uint8_t> sweep_light(const PeriodicTile& tile, const Direction& to_light);

}  // namespace mezzotint
