#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "forward/optics/direction_map.h"
#include "tests/reference/smith_walk.h"

namespace mezzotint::test {

/// What many walks amount to: the reflection as a map, and as shares of all light by order.
struct SmithBsdf {
  static constexpr int kept_orders = 4;  ///< the last: that order and above
  MapEstimate reflection;
  std::array<double, kept_orders> orders{};
  double transmitted = 0.0;
  [[nodiscard]] double albedo() const {
    double sum = 0.0;
    for (const double share : orders) sum += share;
    return sum;
  }
};

inline SmithBsdf smith_bsdf(double gradient, const Material& material, const DirectionAngles& to_light,
                            const DirectionGrid& grid, std::uint64_t paths, std::uint64_t seed) {
  const SmithWalk walk(gradient, material, to_direction(to_light), seed);
  SmithBsdf result;
  std::array<DirectionMap, 2> halves = {DirectionMap(grid.size()), DirectionMap(grid.size())};
  DirectionMap squares(grid.size());
  const double per_path = 1.0 / static_cast<double>(paths);
  for (std::uint64_t k = 0; k < paths; ++k) {
    const auto end = walk.path(k);
    if (!end) continue;
    if (!end->reflected) {
      result.transmitted += per_path;
      continue;
    }
    result.orders[static_cast<std::size_t>(std::min(end->order, SmithBsdf::kept_orders) - 1)] += end->weight * per_path;
    const std::size_t bin = grid.bin_of(end->way.x(), end->way.y());
    halves[k % 2][bin] += 2.0 * end->weight * per_path;
    squares[bin] += end->weight * end->weight * per_path * per_path;
  }
  const auto areas = projected_solid_angles(grid);
  for (std::size_t bin = 0; bin < grid.size(); ++bin) {
    const double scale = areas[bin] > 0.0 ? 1.0 / areas[bin] : 0.0;
    result.reflection.mean.push_back(0.5 * scale * (halves[0][bin] + halves[1][bin]));
    result.reflection.half_a.push_back(scale * halves[0][bin]);
    result.reflection.half_b.push_back(scale * halves[1][bin]);
    result.reflection.standard_error.push_back(scale * std::sqrt(squares[bin]));
  }
  return result;
}

}  // namespace mezzotint::test
