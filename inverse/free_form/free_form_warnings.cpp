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

// RMS width of a lobe across its shorter axis, without what bins and their softening spread.
double shorter_width(const SmoothGrid& grid, const DirectionMap& map) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(light_moments(grid, map).covariance);
  const double bin = 2.0 / static_cast<double>(grid.grid().width);
  return std::sqrt(std::max(0.0, solver.eigenvalues()(0) - bin * bin / 4.0));
}

void add_goal_warnings(const LobeTarget& goal, const PrinterProfile& printer, const FreeFormOptions& options,
                       std::vector<std::string>& warnings) {
  const double ground = ground_rms_slope(printer, split_ground(printer, options.wavelength).geometric);
  warnings = brightness_notes(goal);
  for (std::size_t i = 0; i < goal.maps.size(); ++i) {
    const double cosine = std::cos(goal.incidences[i].theta.radians());
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
  require_possible(goal);
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
