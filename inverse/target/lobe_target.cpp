#include "inverse/target/lobe_target.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

double light_of(const LobeTarget& goal, std::size_t direction) {
  const DirectionMap& map = goal.maps[direction];
  return std::inner_product(map.begin(), map.end(), goal.grid.areas().begin(), 0.0);
}

}  // namespace

LobeTarget lobe_target(const DirectionGrid& grid, const Material& material,
                       const std::vector<DirectionAngles>& incidences, const std::vector<DirectionMap>& maps,
                       bool any_brightness) {
  require(!incidences.empty() && maps.size() == incidences.size(), "a goal needs one map a direction of the light");
  LobeTarget goal{SmoothGrid(grid), material, incidences, {}};
  for (std::size_t i = 0; i < maps.size(); ++i) {
    DirectionMap soft = goal.grid.softened(maps[i]);
    const double light = std::inner_product(soft.begin(), soft.end(), goal.grid.areas().begin(), 0.0);
    require(std::isfinite(light) && light > 0.0, "the lobe that is wanted is dark everywhere");
    if (any_brightness) {
      const double mirrored = reflectance(material, std::cos(incidences[i].theta.radians()));
      for (double& value : soft) value *= mirrored / light;
    }
    goal.maps.push_back(std::move(soft));
  }
  return goal;
}

void require_possible(const LobeTarget& goal, double slack) {
  require(!goal.incidences.empty() && goal.maps.size() == goal.incidences.size(),
          "a goal needs a lobe for each direction of the light, and at least one");
  for (std::size_t i = 0; i < goal.maps.size(); ++i) {
    const DirectionMap& map = goal.maps[i];
    const bool good = map.size() == goal.grid.grid().size() &&
                      std::ranges::all_of(map, [](double f) { return std::isfinite(f) && f >= 0.0; });
    require(good, "the lobe that is wanted must have one value a bin, finite and not negative");
    const double light = light_of(goal, i);
    require(light > 0.0, "the lobe that is wanted is dark everywhere");
    require(light <= 1.0 + slack,
            fmt::format("the lobe that is wanted is brighter than a mirror: it sends back {:.3g} of "
                        "the light that comes; scale it to 1 at most",
                        light));
  }
}

std::vector<std::string> brightness_notes(const LobeTarget& goal) {
  std::vector<std::string> notes;
  for (std::size_t i = 0; i < goal.maps.size(); ++i) {
    const double light = light_of(goal, i),
                 flat = reflectance(goal.material, std::cos(goal.incidences[i].theta.radians()));
    if (light >= 0.95 * flat && light <= 1.05 * flat) continue;
    notes.push_back(
        fmt::format("the goal sends back {:.3g} of the light of direction {}, a flat surface of this "
                    "material {:.3g}: gentle relief cannot change that; a goal of any brightness can",
                    light, i + 1, flat));
  }
  return notes;
}

}  // namespace mezzotint
