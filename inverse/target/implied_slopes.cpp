#include "inverse/target/implied_slopes.h"

#include <algorithm>
#include <cmath>

#include "forward/base/error.h"
#include "inverse/objective/light_moments.h"

namespace mezzotint {

namespace {

// A soft bin is a quadratic spline: its variance along an axis is that of three boxes, in squared bins.
constexpr double soft_bin_variance = 0.25;
constexpr double least_variance = 1e-8;

double square(double value) { return value * value; }

}  // namespace

ImpliedSlopes implied_slopes(const SmoothGrid& grid, const Material& material, const DirectionAngles& to_light,
                             std::span<const double> map) {
  require(map.size() == grid.grid().size(), "a lobe of another grid");
  const Direction light = to_direction(to_light);
  ImpliedSlopes implied;
  double facets = 0.0, xx = 0.0, yy = 0.0, xy = 0.0;
  for (std::size_t k = 0; k < map.size(); ++k) {
    const double light_there = map[k] * grid.areas()[k];
    const Eigen::Vector2d at = bin_middle(grid.grid(), k);
    if (light_there <= 0.0 || at.squaredNorm() >= 1.0) continue;
    const double up = light.z() + std::sqrt(1.0 - at.squaredNorm());
    const double p = -(light.x() + at.x()) / up, q = -(light.y() + at.y()) / up;
    const double toward = light.z() - p * light.x() - q * light.y(), length = std::sqrt(1.0 + p * p + q * q);
    if (toward <= 0.0) continue;
    const double weight = reflectance(material, std::min(1.0, toward / length)) * toward / light.z();
    const double share = light_there / weight;
    implied.light += light_there;
    facets += share;
    implied.mean_x += share * p;
    implied.mean_y += share * q;
    xx += share * p * p;
    yy += share * q * q;
    xy += share * p * q;
  }
  require(facets > 0.0, "a lobe that is dark everywhere speaks of no slopes");
  implied.mean_x /= facets;
  implied.mean_y /= facets;
  // Near the mirror direction a slope moves light by 2·cosθ_i across the plane of incidence and less along it: the
  // smaller width is taken off along both.
  const double bin_x = 1.0 / static_cast<double>(grid.grid().width),
               bin_y = 1.0 / static_cast<double>(grid.grid().height);
  implied.covariance = {
      std::max(least_variance, xx / facets - square(implied.mean_x) - soft_bin_variance * square(bin_x)),
      std::max(least_variance, yy / facets - square(implied.mean_y) - soft_bin_variance * square(bin_y)),
      xy / facets - implied.mean_x * implied.mean_y};
  return implied;
}

ImpliedSlopes implied_slopes(const LobeTarget& target, const std::vector<DirectionMap>& maps) {
  require(!maps.empty() && maps.size() == target.incidences.size(), "one map a direction of the light");
  ImpliedSlopes mean;
  const double share = 1.0 / static_cast<double>(maps.size());
  for (std::size_t light = 0; light < maps.size(); ++light) {
    const ImpliedSlopes one = implied_slopes(target.grid, target.material, target.incidences[light], maps[light]);
    mean.mean_x += share * one.mean_x;
    mean.mean_y += share * one.mean_y;
    mean.covariance.xx += share * one.covariance.xx;
    mean.covariance.yy += share * one.covariance.yy;
    mean.covariance.xy += share * one.covariance.xy;
    mean.light += share * one.light;
  }
  return mean;
}

}  // namespace mezzotint
