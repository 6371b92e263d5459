#include "inverse/design/design.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "forward/pattern/octave_sum.h"

namespace mezzotint {

namespace {

// Seeds of the search and of the verification must never meet, whatever the user's seed.
constexpr std::uint64_t seed_stride = 1000;
constexpr std::uint64_t fresh_offset = 500;

std::vector<std::uint64_t> consecutive_seeds(std::uint64_t first, std::size_t count) {
  std::vector<std::uint64_t> seeds(count);
  for (std::size_t i = 0; i < count; ++i) seeds[i] = first + i;
  return seeds;
}

Length shortest_length(const Pattern& pattern);

template <typename Kind>
Length shortest(const Kind& kind) {
  if constexpr (requires { octave_sum(kind); }) {
    return kind.scale / octave_sum(kind).octaves.back().frequency;
  } else {
    Length least = Length::from_um(HUGE_VAL);
    for (const PatternPart& part : kind.parts) least = std::min(least, shortest_length(part.pattern));
    return least;
  }
}
Length shortest(const LineIntegralConvolution& lines) { return lines.scale; }
Length shortest(const Sinusoid& sinusoid) { return std::min(sinusoid.wavelength_u, sinusoid.wavelength_v); }
Length shortest(const Ridges& ridges) { return ridges.wavelength; }

Length shortest_length(const Pattern& pattern) {
  return std::visit([](const auto& kind) { return shortest(kind); }, pattern);
}

void warn_of_pixels(const DesignProblem& problem, Design& design) {
  const double pixels = shortest_length(design.pattern) / problem.printer.pixel_pitch;
  if (pixels < 4.0) {
    design.warnings.push_back(fmt::format(
        "the pattern's shortest length is {:.1f} pixels; below 4 the pixel grid itself shapes the relief", pixels));
  }
  const Exposure exposure =
      expose(pixel_heights(draw_instance(design.pattern, design.print_seed), problem.printer, problem.patch.pixels),
             problem.printer);
  const double share = static_cast<double>(exposure.saturated) / static_cast<double>(exposure.image.values.size());
  if (share > 0.0) {
    design.warnings.push_back(fmt::format(
        "{:.2g} % of the pixels ask for more than full gray and are cut there; the printer reaches {:.2f} µm",
        100.0 * share, reachable_height(problem.printer).um()));
  }
}

void warn_of_bounds(Design& design) {
  for (std::size_t i = 0; i < design.variables.size(); ++i) {
    const Variable& variable = design.variables[i];
    const double value = design.search.values[i], room = 1e-3 * (variable.high - variable.low);
    if (is_axis(variable)) continue;
    if (value < variable.low + room || value > variable.high - room) {
      design.warnings.push_back(fmt::format("{} = {:.4g} stands at its bound [{}, {}]; the target may need more room",
                                            variable.name, value, variable.low, variable.high));
    }
  }
}

// Held-out ÷ trained, of roots.
void warn_of_overfit(Design& design) {
  for (const JudgedDistance& distance : design.distances) {
    const double train = std::max(distance.on_search_draws, distance.floor), held_out = distance.on_fresh_draws.value,
                 noise = distance.fresh_floor;
    const bool lowered = std::ranges::any_of(
        design.search.lowered, [&](const WeightedMeasure& term) { return term.measure == distance.measure; });
    if (lowered && held_out > 1.3 * 1.3 * train + 9.0 * noise) {
      design.warnings.push_back(
          fmt::format("on draws that the search has not seen the root of {} is {:.2g} times that on its own: it fitted "
                      "its draws; give "
                      "it more draws or a larger patch",
                      name_of(distance.measure), std::sqrt(held_out / train)));
    }
  }
}

// Every draw is off by its own chance; the judgement is on all of them, but one has to be printed.
std::uint64_t closest_draw(const DesignProblem& problem, const Design& design) {
  Target target = problem.target;
  if (problem.by_light) target.slopes = design.on_fresh_draws.axes;
  std::size_t best = 0;
  for (std::size_t i = 1; i < design.fresh_seeds.size(); ++i) {
    const auto distance = [&](std::size_t k) { return covariance_distance(design.fresh_covariances[k], target); };
    if (distance(i) < distance(best)) best = i;
  }
  return design.fresh_seeds[best];
}

// Draws that no search has met: other places of the samples, the printer's levels, a ground of their own.
SlopeModel fresh_model(const DesignProblem& problem, const std::vector<std::uint64_t>& seeds) {
  return {problem.printer,
          problem.patch,
          seeds,
          problem.lobes,
          {.levels = GrayLevels::Quantized, .drawn_ground = true, .place_x = 0.23, .place_y = 0.71}};
}

Estimate jackknife(const DesignGoal& goal, Measure measure, const std::vector<SlopeModel::Shown>& draws) {
  const double value = goal.distance(measure, mean_of(draws));
  const auto n = static_cast<double>(draws.size());
  double spread = 0.0;
  for (std::size_t left_out = 0; left_out < draws.size(); ++left_out) {
    std::vector<SlopeModel::Shown> others = draws;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(left_out));
    spread += std::pow(goal.distance(measure, mean_of(others)) - value, 2);
  }
  return {value, std::sqrt(spread * (n - 1.0) / n)};
}

double value_of(const std::vector<MeasuredDistance>& distances, Measure measure) {
  const auto found = std::ranges::find(distances, measure, &MeasuredDistance::measure);
  return found == distances.end() ? std::numeric_limits<double>::quiet_NaN() : found->value;
}

void judge(const DesignGoal& goal, const std::vector<SlopeModel::Shown>& searched,
           const std::vector<SlopeModel::Shown>& fresh, Design& design) {
  const std::vector<MeasuredDistance> on_search = goal.all(mean_of(searched)), floors = noise_floors(goal, searched),
                                      fresh_floors = noise_floors(goal, fresh);
  for (const MeasuredDistance& trained : on_search) {
    design.distances.push_back({trained.measure, trained.value, value_of(floors, trained.measure),
                                jackknife(goal, trained.measure, fresh), value_of(fresh_floors, trained.measure)});
    if (trained.measure != Measure::CubeRoot || !goal.by_light()) continue;
    const Estimate& square = design.distances.back().on_fresh_draws;
    const double root = std::sqrt(square.value);
    design.fresh_lobe_error = Estimate{root, 0.5 * square.standard_error / root};
  }
}

std::vector<SlopeCovariance> covariances_of(const std::vector<SlopeModel::Shown>& draws) {
  std::vector<SlopeCovariance> covariances;
  covariances.reserve(draws.size());
  for (const SlopeModel::Shown& draw : draws) covariances.push_back(draw.covariance);
  return covariances;
}

SearchPlan plan_of(const DesignProblem& problem) {
  return {.search = problem.search, .objective = problem.objective, .seeds = search_seeds(problem)};
}

}  // namespace

std::vector<std::uint64_t> search_seeds(const DesignProblem& problem) {
  require(problem.search_draws >= 1 && problem.search_draws <= 256, "a search takes 1 to 256 draws");
  return consecutive_seeds(problem.search.seed * seed_stride, problem.search_draws);
}

std::vector<std::uint64_t> fresh_seeds(const DesignProblem& problem) {
  require(problem.fresh_draws >= 2 && problem.fresh_draws <= 256, "a verification takes 2 to 256 fresh draws");
  return consecutive_seeds(problem.search.seed * seed_stride + fresh_offset, problem.fresh_draws);
}

std::vector<Variable> search_variables(const DesignProblem& problem) {
  return design_variables(problem.pattern, problem.free, problem.target, problem.printer, problem.patch.wavelength);
}

Design find_design(const DesignProblem& problem, const Progress& progress) {
  const DesignGoal goal(problem.target, problem.lobes, problem.by_light);
  Design design;
  design.variables = search_variables(problem);
  const SearchPlan plan = plan_of(problem);
  std::optional<EvaluationLog> log;
  if (!problem.log.empty()) log.emplace(problem.log, problem.log_digest);
  design.search = search_pattern(goal, problem.pattern, design.variables, problem.printer, problem.patch, plan,
                                 log ? &*log : nullptr, progress);
  design.pattern = with_values(problem.pattern, design.variables, design.search.values);
  design.warnings = design.search.warnings;

  const auto searched = SlopeModel(problem.printer, problem.patch, plan.seeds, problem.lobes).draws(design.pattern);
  design.on_search_draws = estimate_axes(covariances_of(searched));
  design.fresh_seeds = fresh_seeds(problem);
  const auto fresh = fresh_model(problem, design.fresh_seeds).draws(design.pattern);
  design.fresh_covariances = covariances_of(fresh);
  design.on_fresh_draws = estimate_axes(design.fresh_covariances);
  design.print_seed = closest_draw(problem, design);
  design.fresh_error = target_error(mean_of(design.fresh_covariances).mean, problem.target);
  judge(goal, searched, fresh, design);
  design.met = problem.by_light ? design.fresh_lobe_error->value <= problem.target.tolerance
                                : is_met(design.fresh_error, problem.target);
  warn_of_pixels(problem, design);
  warn_of_bounds(design);
  warn_of_overfit(design);
  return design;
}

}  // namespace mezzotint
