#include <array>
#include <cmath>

#include "forward/bsdf_table/build_bsdf_table.h"
#include "forward/bsdf_table/lobe_warp.h"

namespace mezzotint {

namespace {

using Eigen::Vector2d;

constexpr std::size_t points_a_side = 4;

// A part of the stencil: where a direction of the light that is asked for finds its value in the part's map.
struct Source {
  const MapEstimate* map;
  double weight;
  Eigen::Matrix2d turn;
  std::optional<LobeWarp> warp;

  struct Place {
    std::size_t bin;
    double factor;
  };
  [[nodiscard]] Place find(const DirectionGrid& grid, const Direction& direction) const {
    const Vector2d here = turn * direction.head<2>();
    if (!warp) return {grid.bin_of(here.x(), here.y()), weight};
    const auto [there, jacobian] = (*warp)(here);
    return {grid.bin_of(there.x(), there.y()), weight * jacobian};
  }
};

MapEstimate sum_of(const std::vector<Source>& sources, const DirectionGrid& grid) {
  const auto average = [&](DirectionMap MapEstimate::*which) {
    return average_over_bins(
        grid,
        [&](const Direction& direction) {
          double sum = 0.0;
          for (const Source& source : sources) {
            const auto [bin, factor] = source.find(grid, direction);
            sum += factor * (source.map->*which)[bin];
          }
          return sum;
        },
        points_a_side);
  };
  // Errors of different nodes are added as if they were one: an upper bound, which serves to judge a difference.
  return {average(&MapEstimate::mean), average(&MapEstimate::standard_error), average(&MapEstimate::half_a),
          average(&MapEstimate::half_b)};
}

template <class Chart>
MapEstimate interpolated(const IncidenceGrid& incidences, const std::vector<Bsdf>& nodes,
                         const DirectionAngles& to_light, MapEstimate Bsdf::*map, bool warp, const Chart& chart_of) {
  const Direction light = to_direction(to_light);
  std::vector<Source> sources;
  for (const StencilPart& part : stencil_of(incidences, light)) {
    const Bsdf& node = nodes[part.node];
    Source source{&(node.*map), part.weight, part.turn, std::nullopt};
    if (warp)
      source.warp.emplace(chart_of(light_for(part, light, node.incidence)), chart_of(to_direction(node.incidence)));
    sources.push_back(source);
  }
  return sum_of(sources, nodes.front().grid);
}

}  // namespace

MapEstimate interpolated_reflection(const IncidenceGrid& incidences, const std::vector<Bsdf>& nodes,
                                    const DirectionAngles& to_light, bool warp) {
  return interpolated(incidences, nodes, to_light, &Bsdf::reflection, warp, LobeChart::of_reflection);
}

MapEstimate interpolated_transmission(const IncidenceGrid& incidences, const std::vector<Bsdf>& nodes,
                                      const DirectionAngles& to_light, double relative_index) {
  return interpolated(incidences, nodes, to_light, &Bsdf::transmission, true,
                      [=](const Direction& light) { return LobeChart::of_transmission(light, relative_index); });
}

}  // namespace mezzotint
