#include "inverse/verification/judge_draws.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <tbb/parallel_for.h>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

using Lobes = std::vector<DirectionMap>;  // one a direction of the light
using Draws = std::vector<Lobes>;
using Chosen = std::vector<std::size_t>;

double square(double value) { return value * value; }

// A tracer that corrects a splat may end a little below 0 where nothing arrives: that is dark.
Lobes mean_of(const Draws& draws, const Chosen& chosen) {
  Lobes mean;
  for (const DirectionMap& map : draws.front()) mean.emplace_back(map.size(), 0.0);
  for (const std::size_t draw : chosen) {
    for (std::size_t light = 0; light < mean.size(); ++light) {
      for (std::size_t bin = 0; bin < mean[light].size(); ++bin) mean[light][bin] += draws[draw][light][bin];
    }
  }
  for (DirectionMap& map : mean) {
    for (double& value : map) value = std::max(0.0, value / static_cast<double>(chosen.size()));
  }
  return mean;
}

double distance_of(LobeDistance distance, const SmoothGrid& grid, const Lobes& found, const Lobes& wanted) {
  double sum = 0.0;
  for (std::size_t i = 0; i < found.size(); ++i) sum += lobe_distance(distance, grid, found[i], wanted[i]).value;
  return sum / static_cast<double>(found.size());
}

Chosen all_but(std::size_t count, std::size_t left_out) {
  Chosen chosen;
  for (std::size_t i = 0; i < count; ++i) {
    if (i != left_out) chosen.push_back(i);
  }
  return chosen;
}

// n draws vary as V/n in the mean, and so does the difference of the mean A of one half from that of all: with m =
// (A + B)/2, A − m = (A − B)/2. Halves of a and b draws, a ≠ b, have b/a times the variance.
double floor_of(LobeDistance distance, const SmoothGrid& grid, const Draws& draws, const Chosen& chosen) {
  const std::size_t count = chosen.size(), half = count / 2;
  const Lobes whole = mean_of(draws, chosen);
  double sum = 0.0;
  for (std::size_t first = 0; first < half; ++first) {
    Chosen one, other;
    for (std::size_t i = 0; i < count; ++i) (i < half ? one : other).push_back(chosen[(first + i) % count]);
    sum += distance_of(distance, grid, mean_of(draws, one), whole);
    if (one.size() != other.size()) sum += distance_of(distance, grid, mean_of(draws, other), whole);
  }
  const double cuts = static_cast<double>(half), unequal = static_cast<double>(count - half) / cuts;
  return count % 2 == 0 ? sum / cuts : sum / (cuts * (unequal + 1.0 / unequal));
}

double jackknife_error(const std::vector<double>& without, double whole) {
  double spread = 0.0;
  for (const double value : without) spread += square(value - whole);
  const auto n = static_cast<double>(without.size());
  return std::sqrt(spread * (n - 1.0) / n);
}
double jackknife_error(const std::vector<double>& without) {
  const auto n = static_cast<double>(without.size());
  return jackknife_error(without, std::accumulate(without.begin(), without.end(), 0.0) / n);
}

JudgedDistance judged(LobeDistance distance, const Draws& draws, const LobeTarget& goal) {
  const std::size_t count = draws.size();
  const double fewer = static_cast<double>(count - 1) / static_cast<double>(count);
  std::vector<double> squares(count), roots(count), floors(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    const Chosen rest = all_but(count, i);
    squares[i] = distance_of(distance, goal.grid, mean_of(draws, rest), goal.maps);
    roots[i] = std::sqrt(squares[i]);
    floors[i] = fewer * floor_of(distance, goal.grid, draws, rest);
  });
  const Chosen all = all_but(count, count);
  const double value = distance_of(distance, goal.grid, mean_of(draws, all), goal.maps);
  const double floor = floor_of(distance, goal.grid, draws, all);
  return {.distance = distance,
          .square = {value, jackknife_error(squares)},
          .root = {std::sqrt(value), jackknife_error(roots)},
          .floor = {floor, jackknife_error(floors)},
          .root_floor = std::sqrt(floor)};
}

double light_of(const SmoothGrid& grid, const DirectionMap& map) {
  return std::inner_product(map.begin(), map.end(), grid.areas().begin(), 0.0);
}

Estimate mean_with_error(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double spread = 0.0;
  for (const double value : values) spread += square(value - mean);
  return {mean, std::sqrt(spread / (n * (n - 1.0)))};
}

MeanLobe mean_lobe(const Draws& draws, std::size_t light) {
  const std::size_t bins = draws.front()[light].size();
  MeanLobe lobe{DirectionMap(bins), DirectionMap(bins), DirectionMap(bins), DirectionMap(bins)};
  const auto halves = [&](std::size_t i) -> DirectionMap& { return i % 2 == 0 ? lobe.half_a : lobe.half_b; };
  const std::size_t in_a = (draws.size() + 1) / 2, in_b = draws.size() / 2;
  std::vector<double> values(draws.size());
  for (std::size_t bin = 0; bin < bins; ++bin) {
    for (std::size_t i = 0; i < draws.size(); ++i) {
      values[i] = draws[i][light][bin];
      halves(i)[bin] += values[i] / static_cast<double>(i % 2 == 0 ? in_a : in_b);
    }
    const Estimate estimate = mean_with_error(values);
    lobe.mean[bin] = estimate.value;
    lobe.standard_error[bin] = estimate.standard_error;
  }
  return lobe;
}

void require_draws(const Draws& draws, const LobeTarget& goal) {
  require(!goal.maps.empty() && goal.maps.size() == goal.incidences.size(),
          "lobes are judged against a goal with one map a direction of the light, and at least one");
  require(draws.size() >= 4, "lobes are judged by 4 draws or more; these are " + std::to_string(draws.size()));
  for (const Lobes& lobes : draws) {
    const bool fits = lobes.size() == goal.maps.size() && std::ranges::all_of(lobes, [&](const DirectionMap& map) {
                        return map.size() == goal.grid.grid().size();
                      });
    require(fits, "every draw needs one map a direction of the light, on the goal's grid");
  }
}

}  // namespace

std::string_view root_name_of(LobeDistance distance) {
  switch (distance) {
    case LobeDistance::L2:
      return "relative_l2";
    case LobeDistance::CubeRoot:
      return "cube_root_error";
    case LobeDistance::Logarithm:
      return "log_error";
    case LobeDistance::Wasserstein:
      return "sliced_wasserstein_error";
    case LobeDistance::Moments:
      break;
  }
  return "moments_error";
}

const JudgedDistance& LobeJudgement::by(LobeDistance distance) const {
  const auto found = std::ranges::find(distances, distance, &JudgedDistance::distance);
  require(found != distances.end(), "this judgement is empty");
  return *found;
}

std::vector<double> wanted_light(const LobeTarget& goal) {
  std::vector<double> light;
  light.reserve(goal.maps.size());
  for (const DirectionMap& map : goal.maps) light.push_back(light_of(goal.grid, map));
  return light;
}

LobeJudgement judge_draws(const std::vector<std::vector<DirectionMap>>& draws, const LobeTarget& goal) {
  require_draws(draws, goal);
  LobeJudgement judgement;
  for (std::size_t light = 0; light < goal.maps.size(); ++light) {
    judgement.lobes.push_back(mean_lobe(draws, light));
    std::vector<double> reflected;
    for (const Lobes& lobes : draws) reflected.push_back(light_of(goal.grid, lobes[light]));
    judgement.reflected.push_back(mean_with_error(reflected));
  }
  for (const LobeDistance distance : all_lobe_distances) judgement.distances.push_back(judged(distance, draws, goal));
  return judgement;
}

}  // namespace mezzotint
