#include "inverse/target/lobe_target.h"

#include <cmath>
#include <numeric>

#include "forward/base/error.h"

namespace mezzotint {

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

}  // namespace mezzotint
