#include "measurement/reflectance/reflectance_map.h"

#include <cmath>
#include <numbers>

#include "forward/base/error.h"

namespace mezzotint {

ReflectanceMap reflectance_map(const MeasuredReflectance& measured, const DirectionAngles& to_light,
                               const ChannelChoice& channel, const DirectionGrid& grid, std::size_t samples) {
  const std::string refusal = refusal_of_incidence(measured, to_light);
  require(refusal.empty(), refusal);
  const ChannelWeights weights = channel_weights(measured, channel);
  const Direction light = to_direction(to_light);
  const auto value = [&](const Direction& viewer) { return evaluate(measured, light, viewer, weights); };
  ReflectanceMap result;
  result.map = average_over_bins(
      grid,
      [&](const Direction& viewer) {
        const double sample = value(viewer);
        return std::isnan(sample) ? 0.0 : sample;
      },
      samples);
  result.measured = average_over_bins(
      grid, [&](const Direction& viewer) { return std::isnan(value(viewer)) ? 0.0 : 1.0; }, samples);
  const std::vector<double> areas = projected_solid_angles(grid);
  double measured_area = 0.0;
  for (std::size_t k = 0; k < areas.size(); ++k) {
    result.albedo += areas[k] * result.map[k];
    measured_area += areas[k] * result.measured[k];
    if (result.measured[k] > 0.0) result.map[k] /= result.measured[k];
  }
  result.not_measured_share = std::max(0.0, 1.0 - measured_area / std::numbers::pi);
  return result;
}

}  // namespace mezzotint
