#include "inverse/free_form/free_form_warnings.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <Eigen/Eigenvalues>

#include "forward/base/error.h"
#include "inverse/objective/light_moments.h"

namespace mezzotint {

namespace {

constexpr double most_overfit = 1.3;  // held-out ÷ trained, of roots

void require_valid_goal(const LobeTarget& goal) {
  require(!goal.incidences.empty() && goal.maps.size() == goal.incidences.size(),
          "a free form needs a lobe for each direction of the light, and at least one");
  for (const DirectionMap& map : goal.maps) {
    const bool good = map.size() == goal.grid.grid().size() &&
                      std::ranges::all_of(map, [](double f) { return std::isfinite(f) && f >= 0.0; });
    require(good, "the lobe that is wanted must have one value a bin, finite and not negative");
  }
  for (const double light : wanted_light(goal)) {
    require(light > 0.0, "the lobe that is wanted is dark everywhere");
    require(light <= 1.0 + 1e-6,
            fmt::format("the lobe that is wanted is brighter than a mirror: it sends back {:.3g} of "
                        "the light that comes; scale it to 1 at most",
                        light));
  }
}

// RMS width of a lobe across its shorter axis, without what bins and their softening spread.
double shorter_width(const SmoothGrid& grid, const DirectionMap& map) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(light_moments(grid, map).covariance);
  const double bin = 2.0 / static_cast<double>(grid.grid().width);
  return std::sqrt(std::max(0.0, solver.eigenvalues()(0) - bin * bin / 4.0));
}

void add_goal_warnings(const LobeTarget& goal, const PrinterProfile& printer, const FreeFormOptions& options,
                       std::vector<std::string>& warnings) {
  const double ground = ground_rms_slope(printer, split_ground(printer, options.wavelength).geometric);
  const std::vector<double> lights = wanted_light(goal);
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const double cosine = std::cos(goal.incidences[i].theta.radians());
    const double flat = reflectance(goal.material, cosine);
    if (lights[i] > 1.05 * flat || lights[i] < 0.95 * flat) {
      warnings.push_back(
          fmt::format("the goal sends back {:.3g} of the light of direction {}, a flat surface of this "
                      "material {:.3g}: gentle relief cannot change that; a goal of any brightness can",
                      lights[i], i + 1, flat));
    }
    if (shorter_width(goal.grid, goal.maps[i]) < 2.0 * cosine * ground) {
      warnings.push_back(
          fmt::format("the goal's lobe of direction {} is narrower than what the printer's ground "
                      "scatters (RMS slope {:.2g}): no print is as smooth",
                      i + 1, ground));
    }
  }
}

void require_valid_objective(const std::vector<WeightedDistance>& objective) {
  double sum = 0.0;
  for (const WeightedDistance& part : objective) {
    require(std::isfinite(part.weight) && part.weight >= 0.0, "weights of distances must be finite and not negative");
    sum += part.weight;
  }
  require(sum > 0.0, "an objective needs a distance of positive weight");
}

}  // namespace

void require_valid_search(const LobeTarget& goal, const FreeFormOptions& options) {
  require_valid_goal(goal);
  require(options.pixels >= 16 && options.pixels <= 1024, "a free form has 16 to 1024 pixels a side");
  require(options.fresh_draws >= 4 && options.fresh_draws <= 64, "a verdict takes 4 to 64 fresh draws");
  require(options.start_evaluations >= 1 && options.evaluations >= 1 && options.evaluations_per_epoch >= 1,
          "a free form needs at least one evaluation from each start and in each epoch");
  require(options.traced_corrections >= 0 && options.traced_corrections <= 10, "0 to 10 traced corrections");
  require_valid_objective(options.start_objective);
  require_valid_objective(options.objective);
}

double weighted_sum(const std::vector<WeightedDistance>& objective, const LobeJudgement& judgement,
                    Estimate JudgedDistance::*figure) {
  double sum = 0.0;
  for (const WeightedDistance& part : objective) sum += part.weight * (judgement.by(part.distance).*figure).value;
  return sum;
}

std::vector<std::string> free_form_warnings(const LobeTarget& goal, const PrinterProfile& printer,
                                            const FreeFormOptions& options, const FreeForm& found) {
  std::vector<std::string> warnings;
  add_goal_warnings(goal, printer, options, warnings);
  if (*std::ranges::min_element(found.history) > 0.98 * found.history.front())
    warnings.emplace_back("the search did not get away from its start: the objective is flat there");
  const double held_out = weighted_sum(options.objective, found.verified.traced);
  const double floor = weighted_sum(options.objective, found.verified.traced, &JudgedDistance::floor);
  const double ratio = std::sqrt(held_out / found.on_search_draws);
  if (ratio > most_overfit && held_out > 2.0 * floor) {
    warnings.push_back(
        fmt::format("printed anew and traced, its error is {:.2f} times that of the search (root of the "
                    "objective)",
                    ratio));
  }
  return warnings;
}

}  // namespace mezzotint
