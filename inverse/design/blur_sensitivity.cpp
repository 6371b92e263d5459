#include "inverse/design/blur_sensitivity.h"

#include <algorithm>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

BlurredPrint blurred(const DesignProblem& problem, const Design& design, const DesignGoal& goal, double factor) {
  PrinterProfile printer = problem.printer;
  printer.spread.width = factor * printer.spread.width;
  const auto draws = fresh_model(problem, printer, design.fresh_seeds).draws(design.pattern);
  std::vector<SlopeCovariance> covariances;
  covariances.reserve(draws.size());
  for (const SlopeModel::Shown& draw : draws) covariances.push_back(draw.covariance);
  const SlopeModel::Shown mean = mean_of(draws);
  return {factor, printer.spread.width, mean.covariance, estimate_axes(covariances),
          goal.distance(design.search.lowered, mean)};
}

void require_factors(const std::vector<double>& factors) {
  require(!factors.empty() && std::ranges::all_of(factors, [](double factor) { return factor > 0.0; }),
          "a blur is changed by factors above 0, like 0.7 and 1.3");
}

}  // namespace

std::vector<BlurredPrint> blur_sensitivity(const DesignProblem& problem, const Design& design,
                                           const std::vector<double>& factors) {
  require_factors(factors);
  const DesignGoal goal(problem.target, problem.lobes, problem.by_light);
  std::vector<BlurredPrint> prints;
  prints.reserve(factors.size());
  for (const double factor : factors) prints.push_back(blurred(problem, design, goal, factor));
  return prints;
}

std::vector<BlurredPrint> blur_sensitivity(const GrayImage& gray, const PrinterProfile& printer, const LobeTarget& goal,
                                           const DrawOptions& draw, const std::vector<std::uint64_t>& seeds,
                                           const std::vector<double>& factors) {
  require_factors(factors);
  std::vector<BlurredPrint> prints;
  for (const double factor : factors) {
    PrinterProfile blurry = printer;
    blurry.spread.width = factor * printer.spread.width;
    std::vector<SlopeCovariance> covariances;
    std::vector<std::vector<DirectionMap>> lobes;
    for (const std::uint64_t seed : seeds) {
      const HeightField relief = print_draw(gray, blurry, draw, seed);
      covariances.push_back(slope_covariance(relief));
      lobes.push_back(slope_lobes(relief, goal));
    }
    prints.push_back({factor, blurry.spread.width, mean_of(covariances).mean, estimate_axes(covariances),
                      judge_draws(lobes, goal).by(LobeDistance::CubeRoot).square.value});
  }
  return prints;
}

}  // namespace mezzotint
