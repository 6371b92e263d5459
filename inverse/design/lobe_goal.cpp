#include "inverse/design/lobe_goal.h"

#include <cmath>
#include <limits>

#include <tbb/parallel_for.h>

#include "forward/base/error.h"
#include "forward/scattering/slope_splat.h"

namespace mezzotint {

namespace {

double square(double value) { return value * value; }

// Sums of all draws, for every incidence one map after the other.
std::vector<double> summed(const std::vector<std::vector<DirectionMap>>& draws) {
  std::vector<double> sum;
  for (const auto& map : draws.front()) sum.insert(sum.end(), map.size(), 0.0);
  for (const auto& draw : draws) {
    std::size_t at = 0;
    for (const auto& map : draw) {
      for (const double value : map) sum[at++] += value;
    }
  }
  return sum;
}

// The goal's side of the figure, made once.
struct Reference {
  explicit Reference(const LobeGoal& goal) {
    const auto areas = projected_solid_angles(goal.grid);
    for (const auto& map : goal.maps) {
      for (std::size_t bin = 0; bin < map.size(); ++bin) {
        area.push_back(areas[bin]);
        root.push_back(std::cbrt(map[bin]));
        power += areas[bin] * square(root.back());
      }
    }
    require(power > 0.0, "the lobe that is wanted is dark everywhere");
  }
  [[nodiscard]] double error_of(const std::vector<double>& sum, double per_draw) const {
    double distance = 0.0;
    for (std::size_t i = 0; i < sum.size(); ++i) distance += area[i] * square(std::cbrt(sum[i] * per_draw) - root[i]);
    return std::sqrt(distance / power);
  }

  std::vector<double> area, root;
  double power = 0.0;
};

double without_draw(const Reference& reference, std::vector<double> sum, const std::vector<DirectionMap>& draw,
                    double per_draw) {
  std::size_t at = 0;
  for (const auto& map : draw) {
    // What is left after a subtraction may be a rounding below zero.
    for (const double value : map) sum[at] = std::max(0.0, sum[at] - value), ++at;
  }
  return reference.error_of(sum, per_draw);
}

}  // namespace

LobeGoal lobe_goal_of(const HeightField& relief, const Material& material,
                      const std::vector<DirectionAngles>& incidences, const DirectionGrid& grid) {
  require(!incidences.empty(), "a lobe needs at least one direction of the light");
  LobeGoal goal{grid, material, incidences, {}};
  for (const auto& incidence : incidences) goal.maps.push_back(slope_reflection_map(relief, material, incidence, grid));
  return goal;
}

std::vector<std::vector<DirectionMap>> printed_lobes(const PrintedTexture& texture, const Pattern& pattern,
                                                     GrayLevels levels, const LobeGoal& goal) {
  std::vector<std::vector<DirectionMap>> draws(texture.seeds().size());
  tbb::parallel_for(std::size_t{0}, draws.size(), [&](std::size_t i) {
    const HeightField relief = texture.print(pattern, i, levels);
    for (const auto& incidence : goal.incidences) {
      draws[i].push_back(slope_reflection_map(relief, goal.material, incidence, goal.grid));
    }
  });
  return draws;
}

Estimate cube_root_error(const std::vector<std::vector<DirectionMap>>& draws, const LobeGoal& goal) {
  require(!draws.empty(), "the lobe of no draws");
  const Reference reference(goal);
  const std::vector<double> sum = summed(draws);
  const auto n = static_cast<double>(draws.size());
  const double error = reference.error_of(sum, 1.0 / n);
  if (draws.size() < 2) return {error, std::numeric_limits<double>::quiet_NaN()};
  std::vector<double> squares(draws.size());
  tbb::parallel_for(std::size_t{0}, draws.size(), [&](std::size_t i) {
    squares[i] = square(without_draw(reference, sum, draws[i], 1.0 / (n - 1.0)) - error);
  });
  double spread = 0.0;
  for (const double value : squares) spread += value;
  return {error, std::sqrt(spread * (n - 1.0) / n)};
}

}  // namespace mezzotint
