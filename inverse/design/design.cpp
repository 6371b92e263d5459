#include "inverse/design/design.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "forward/pattern/octave_sum.h"
#include "forward/pattern/pattern_parameters.h"
#include "inverse/design/closed_form_start.h"

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

const PatternParameter& table_entry(const Pattern& pattern, const FreeParameter& parameter) {
  const auto& table = pattern_parameters(pattern);
  const auto found = std::ranges::find(table, parameter.name, &PatternParameter::name);
  require(found != table.end(),
          fmt::format("a pattern of kind \"{}\" has no parameter \"{}\"", kind_name(pattern), parameter.name));
  require(!found->whole,
          fmt::format("{} is a whole number; a search cannot change it, so give it a value", parameter.name));
  require(parameter.low >= found->lowest && parameter.high <= found->highest,
          fmt::format("{}: the bounds must lie in [{}, {}]", parameter.name, found->lowest, found->highest));
  return *found;
}

// An axis turned by half a turn is the same axis: bring the start between the bounds if that is possible.
double into_bounds(double value, const FreeParameter& parameter) {
  if (parameter.name == "direction_deg") {
    while (value > parameter.high && value - 180.0 >= parameter.low) value -= 180.0;
    while (value < parameter.low && value + 180.0 <= parameter.high) value += 180.0;
  }
  return std::clamp(value, parameter.low, parameter.high);
}

Pattern with_values(Pattern pattern, const std::vector<Variable>& variables, const std::vector<double>& values) {
  for (std::size_t i = 0; i < variables.size(); ++i) set_parameter(pattern, variables[i].name, values[i]);
  return pattern;
}

template <typename Kind>
Length shortest(const Kind& kind) {
  if constexpr (requires { octave_sum(kind); }) return kind.scale / octave_sum(kind).octaves.back().frequency;
  return Length::from_um(HUGE_VAL);  // a composition, which is not searched
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
    const double value = design.search.best.values[i], room = 1e-3 * (variable.high - variable.low);
    if (variable.name == "direction_deg") continue;
    if (value < variable.low + room || value > variable.high - room) {
      design.warnings.push_back(fmt::format("{} = {:.4g} stands at its bound [{}, {}]; the target may need more room",
                                            variable.name, value, variable.low, variable.high));
    }
  }
}

void warn_of_overfit(const DesignProblem& problem, Design& design) {
  if (problem.lobe) return;  // the two figures are of different kinds
  const double held_out = covariance_distance(mean_of(design.fresh_covariances).mean, problem.target);
  const double noise = 2.0 * std::pow(design.on_fresh_draws.rms_major_error / design.on_fresh_draws.axes.rms_major, 2) +
                       2.0 * std::pow(design.on_fresh_draws.rms_minor_error / design.on_fresh_draws.axes.rms_minor, 2);
  if (held_out > design.search.best.objective + 9.0 * 4.0 * noise) {
    design.warnings.push_back(
        "the fresh draws are further off than their own scatter explains: the search fitted its draws; give it more "
        "draws or a larger patch");
  }
}

// Every draw is off by its own chance; the judgement is on all of them, but one has to be printed.
std::uint64_t closest_draw(const DesignProblem& problem, const Design& design) {
  Target target = problem.target;
  if (problem.lobe) target.slopes = design.on_fresh_draws.axes;
  std::size_t best = 0;
  for (std::size_t i = 1; i < design.fresh_seeds.size(); ++i) {
    const auto distance = [&](std::size_t k) { return covariance_distance(design.fresh_covariances[k], target); };
    if (distance(i) < distance(best)) best = i;
  }
  return design.fresh_seeds[best];
}

double mean_lobe_error(const PrintedTexture& texture, const Pattern& pattern, const LobeGoal& lobe) {
  return cube_root_error(printed_lobes(texture, pattern, GrayLevels::Continuous, lobe), lobe).value;
}

MinimizeResult run_search(const DesignProblem& problem, Design& design, const Progress& progress) {
  const PrintedTexture texture(problem.printer, problem.patch, search_seeds(problem));
  const auto objective = [&](const std::vector<double>& values) {
    const Pattern pattern = with_values(problem.pattern, design.variables, values);
    if (problem.lobe) return mean_lobe_error(texture, pattern, *problem.lobe);
    return covariance_distance(mean_of(texture.slope_covariances(pattern, GrayLevels::Continuous)).mean,
                               problem.target);
  };
  const auto observer = [&](int evaluation, const SearchStep& step) {
    design.history.push_back(step);
    report(progress, "search", static_cast<double>(evaluation) / problem.search.max_evaluations,
           fmt::format("evaluation {}, distance {:.2e}", evaluation, step.objective));
  };
  MinimizeResult result = minimize(design.variables, objective, problem.search, observer);
  const Pattern best = with_values(problem.pattern, design.variables, result.best.values);
  design.on_search_draws = estimate_axes(texture.slope_covariances(best, GrayLevels::Continuous));
  report(progress, "search", 1.0, fmt::format("{} evaluations, {}", result.evaluations, result.outcome));
  return result;
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
  require(parts_of(problem.pattern) == nullptr,
          fmt::format("a composed pattern (\"{}\") cannot be searched yet; search one of its parts",
                      kind_name(problem.pattern)));
  const Pattern start = closed_form_start(problem.pattern, problem.target, problem.printer, problem.patch.wavelength);
  std::vector<Variable> variables;
  for (const auto& parameter : problem.free) {
    const PatternParameter& entry = table_entry(problem.pattern, parameter);
    const double value = parameter.start.value_or(into_bounds(get_parameter(start, parameter.name), parameter));
    variables.push_back({parameter.name, parameter.low, parameter.high, value, entry.logarithmic});
  }
  return variables;
}

Design find_design(const DesignProblem& problem, const Progress& progress) {
  Design design;
  design.variables = search_variables(problem);
  design.search = run_search(problem, design, progress);
  design.pattern = with_values(problem.pattern, design.variables, design.search.best.values);

  design.fresh_seeds = fresh_seeds(problem);
  const PrintedTexture fresh(problem.printer, problem.patch, design.fresh_seeds);
  design.fresh_covariances = fresh.slope_covariances(design.pattern, GrayLevels::Quantized);
  design.on_fresh_draws = estimate_axes(design.fresh_covariances);
  design.print_seed = closest_draw(problem, design);
  design.fresh_error = target_error(mean_of(design.fresh_covariances).mean, problem.target);
  design.met = is_met(design.fresh_error, problem.target);
  if (problem.lobe) {
    const auto lobes = printed_lobes(fresh, design.pattern, GrayLevels::Quantized, *problem.lobe);
    design.fresh_lobe_error = cube_root_error(lobes, *problem.lobe);
    design.met = design.fresh_lobe_error->value <= problem.target.tolerance;
  }
  warn_of_pixels(problem, design);
  warn_of_bounds(design);
  warn_of_overfit(problem, design);
  return design;
}

}  // namespace mezzotint
