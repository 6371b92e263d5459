#include "inverse/objective/smooth_lobe.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <tbb/parallel_for.h>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

constexpr std::size_t reflectance_steps = 2048;

// Catmull and Rom's cubics: continuous slopes. One step beyond either end by a parabola through the nearest three.
CurveCells reflectance_cells(const Material& material) {
  std::vector<double> nodes(reflectance_steps + 3);  // nodes[0] stands one step before the first one
  for (std::size_t i = 0; i <= reflectance_steps; ++i)
    nodes[i + 1] = reflectance(material, static_cast<double>(i) / reflectance_steps);
  nodes.front() = 3.0 * (nodes[1] - nodes[2]) + nodes[3];
  nodes.back() = 3.0 * (nodes[reflectance_steps + 1] - nodes[reflectance_steps]) + nodes[reflectance_steps - 1];
  CurveCells cells{reflectance_steps, {}};
  for (std::size_t i = 0; i < reflectance_steps; ++i) {
    const double p0 = nodes[i], p1 = nodes[i + 1], p2 = nodes[i + 2], p3 = nodes[i + 3];
    cells.terms.insert(cells.terms.end(),
                       {0.5 * (3.0 * (p1 - p2) + p3 - p0), p0 - 2.5 * p1 + 2.0 * p2 - 0.5 * p3, 0.5 * (p2 - p0), p1});
  }
  // What stands in the last node, and in a rounding beyond it, has a cell of its own.
  const double before = nodes[reflectance_steps], last = nodes[reflectance_steps + 1], after = nodes.back();
  cells.terms.insert(cells.terms.end(), {0.0, 0.0, 0.5 * (after - before), last});
  return cells;
}

// Parts of all points, each summed by itself: the same order with any number of threads. Enough points in each that its
// own bins cost little beside them.
struct Parts {
  std::size_t points, count;

  Parts(std::size_t all_points, std::size_t bins)
      : points(all_points), count(std::clamp<std::size_t>(all_points / std::max<std::size_t>(8192, 2 * bins), 1, 32)) {}
  [[nodiscard]] std::size_t first(std::size_t part) const { return part * points / count; }
};

FacetSlopes some_of(std::span<const float> slopes_x, std::span<const float> slopes_y, const Parts& parts,
                    std::size_t part) {
  const std::size_t first = parts.first(part);
  return {slopes_x.data() + first, slopes_y.data() + first, parts.first(part + 1) - first};
}

void require_points(std::span<const float> slopes_x, std::span<const float> slopes_y) {
  require(!slopes_x.empty() && slopes_x.size() == slopes_y.size(), "a lobe needs two slopes a point, and a point");
  require(all_finite(slopes_x) && all_finite(slopes_y), "slopes must be finite; fill missing samples first");
}

// The bin that one of the frame counts for, along one axis.
std::size_t inner_bin(std::size_t framed, std::size_t bins) { return std::clamp<std::size_t>(framed, 1, bins) - 1; }

template <class Visit>
void for_each_framed(const LobePlan& plan, const Visit& visit) {
  for (std::size_t row = 0; row < plan.bins_y + 2; ++row) {
    for (std::size_t column = 0; column < plan.bins_x + 2; ++column)
      visit(row * plan.framed_stride() + column,
            inner_bin(row, plan.bins_y) * plan.bins_x + inner_bin(column, plan.bins_x));
  }
}

}  // namespace

SmoothLobe::SmoothLobe(const SmoothGrid& grid, const Material& material, const DirectionAngles& to_light)
    : grid_(grid) {
  const double theta = to_light.theta.radians();
  require(theta >= 0.0 && theta < 0.5 * std::numbers::pi && std::isfinite(to_light.phi.radians()),
          "the light stands above the horizon: theta from 0 to less than 90 degrees");
  const Direction light = to_direction(to_light);
  plan_ = {light.x(), light.y(), light.z(), reflectance_cells(material), grid.grid().width, grid.grid().height};
}

DirectionMap SmoothLobe::map(std::span<const float> slopes_x, std::span<const float> slopes_y) const {
  require_points(slopes_x, slopes_y);
  const Parts parts(slopes_x.size(), plan_.framed_size());
  std::vector<std::vector<double>> lights(parts.count);
  tbb::parallel_for(std::size_t{0}, parts.count, [&](std::size_t part) {
    lights[part].assign(plan_.framed_size(), 0.0);
    add_facet_light(plan_, some_of(slopes_x, slopes_y, parts, part), lights[part].data());
  });
  std::vector<double>& sum = lights.front();
  for (std::size_t part = 1; part < parts.count; ++part) {
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += lights[part][k];
  }
  DirectionMap map(grid_.grid().size(), 0.0);
  for_each_framed(plan_, [&](std::size_t framed, std::size_t bin) { map[bin] += sum[framed]; });
  const auto points = static_cast<double>(slopes_x.size());
  for (std::size_t k = 0; k < map.size(); ++k)
    map[k] = grid_.areas()[k] > 0.0 ? map[k] / (points * grid_.areas()[k]) : 0.0;
  return map;
}

void SmoothLobe::add_slope_derivatives(std::span<const float> slopes_x, std::span<const float> slopes_y,
                                       std::span<const double> map_derivatives, double share, std::span<float> toward_x,
                                       std::span<float> toward_y) const {
  require_points(slopes_x, slopes_y);
  require(map_derivatives.size() == grid_.grid().size(), "one derivative a bin is needed");
  require(toward_x.size() == slopes_x.size() && toward_y.size() == slopes_x.size(), "room for one derivative a slope");
  std::vector<double> value_of_light(plan_.framed_size(), 0.0);
  const double share_of_point = share / static_cast<double>(slopes_x.size());
  for_each_framed(plan_, [&](std::size_t framed, std::size_t bin) {
    const double area = grid_.areas()[bin];
    if (area > 0.0) value_of_light[framed] = share_of_point * map_derivatives[bin] / area;
  });
  const Parts parts(slopes_x.size(), plan_.framed_size());
  tbb::parallel_for(std::size_t{0}, parts.count, [&](std::size_t part) {
    const std::size_t first = parts.first(part);
    add_facet_derivatives(plan_, some_of(slopes_x, slopes_y, parts, part), value_of_light.data(),
                          toward_x.data() + first, toward_y.data() + first);
  });
}

}  // namespace mezzotint
