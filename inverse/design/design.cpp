#include "inverse/design/design.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "forward/pattern/octave_sum.h"

namespace mezzotint {

namespace {

// Seeds of the search and of the verification must never meet, whatever the user's seed.
constexpr std::uint64_t seed_stride = 1000;
constexpr std::uint64_t fresh_offset = 500;
constexpr double most_held_out_ratio = 1.3;
constexpr int few_levels = 14;
// Noise may make a measured lobe a little brighter than a mirror.
constexpr double brightness_slack = 0.05;

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

// Rounding to few levels makes steps of what should be slopes.
void warn_of_levels(const DesignProblem& problem, Design& design) {
  const HeightField heights =
      pixel_heights(draw_instance(design.pattern, design.print_seed), problem.printer, problem.patch.pixels);
  std::vector<float> levels = quantize(expose(heights, problem.printer).image, problem.printer).values;
  std::ranges::sort(levels);
  const auto used = std::ranges::unique(levels).begin() - levels.begin();
  if (used >= few_levels) return;
  design.warnings.push_back(fmt::format(
      "the relief uses {} of the printer's {} gray levels; below {} their rounding shifts its slopes by some per cent: "
      "use a larger height and longer wavelengths",
      used, problem.printer.gray_levels, few_levels));
}

void warn_of_lobes(const DesignProblem& problem, Design& design) {
  if (!problem.lobes) return;
  if (problem.target.kind == "ggx") {
    design.warnings.push_back(fmt::format(
        "slopes of a GGX lobe have no RMS: those that are compared, {:.3g} and {:.3g}, are what its light above the "
        "horizon shows, more than α/√2 and other ones for other directions of the light; judge by the lobe's distances",
        problem.target.slopes.rms_major, problem.target.slopes.rms_minor));
  }
  if (!problem.by_light) return;
  std::ranges::move(brightness_notes(*problem.lobes), std::back_inserter(design.warnings));
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

// What is met is met on fresh draws, however well the search's own may look.
void warn_of_overfit(const Target& target, Design& design) {
  if (design.held_out_ratio <= most_held_out_ratio || (is_judged(target) && design.met)) return;
  design.warnings.push_back(
      fmt::format("on draws that the search has not seen the error is {:.2g} times that on its own: it fitted its "
                  "draws; give it more draws or a larger patch",
                  design.held_out_ratio));
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

std::vector<std::vector<DirectionMap>> maps_of(const std::vector<SlopeModel::Shown>& draws) {
  std::vector<std::vector<DirectionMap>> maps;
  maps.reserve(draws.size());
  for (const SlopeModel::Shown& draw : draws) maps.push_back(draw.maps);
  return maps;
}

// Of roots, each with what its draws' own scatter gives added to the search's: a search without error has no ratio.
double held_out_ratio(const DesignGoal& goal, const MeasureSum& lowered, const std::vector<SlopeModel::Shown>& searched,
                      const std::vector<SlopeModel::Shown>& fresh, const Design& design) {
  // A search for slopes sees its draws brought to the mean over all of them: its own figure is the trained one.
  const double seen = goal.distance(lowered, mean_of(searched)), held_out = goal.distance(lowered, mean_of(fresh)),
               trained = goal.by_light() ? seen : std::min(seen, design.search.objective);
  double noise = 0.0;
  for (const WeightedMeasure& term : lowered) {
    const auto kind = lobe_distance_of(term.measure);
    if (kind && design.on_fresh_lobes) noise += term.weight * design.on_fresh_lobes->by(*kind).floor.value;
    if (!kind) {
      const SlopeAxesEstimate& e = design.on_fresh_draws;
      noise += term.weight * 4.0 *
               (std::pow(e.rms_major_error / e.axes.rms_major, 2) + std::pow(e.rms_minor_error / e.axes.rms_minor, 2));
      // A turned covariance is off the diagonal of the other's frame by that.
      const double ratio = e.axes.rms_major / e.axes.rms_minor,
                   turn = goal.target().rotation_matters ? e.rotation_error.radians() : 0.0;
      noise += term.weight * 2.0 * std::pow(turn * (ratio - 1.0 / ratio), 2);
    }
  }
  return std::sqrt((held_out + noise) / (trained + 2.0 * noise));
}

// The slopes, and with lobes every distance, by slopes alone.
void judge(const DesignGoal& goal, const std::vector<SlopeModel::Shown>& searched,
           const std::vector<SlopeModel::Shown>& fresh, Design& design) {
  if (!goal.lobes()) return;
  if (searched.size() >= 4) design.on_search_lobes = judge_draws(maps_of(searched), *goal.lobes());
  if (fresh.size() < 4) return;
  design.on_fresh_lobes = judge_draws(maps_of(fresh), *goal.lobes());
  if (goal.by_light()) design.fresh_lobe_error = design.on_fresh_lobes->by(LobeDistance::CubeRoot).root;
}

void trace_verdict(const DesignProblem& problem, Design& design, const Progress& progress) {
  const std::size_t draws = std::min(problem.traced_draws, design.fresh_seeds.size());
  if (!problem.lobes || draws < 4) return;
  const GrayOfSeed gray = [&](std::uint64_t seed) {
    return expose(pixel_heights(draw_instance(design.pattern, seed), problem.printer, problem.patch.pixels),
                  problem.printer)
        .image;
  };
  VerificationOptions options;
  options.draw.subsamples = std::max<std::size_t>(options.draw.subsamples, problem.patch.subsamples);
  options.draw.wavelength = problem.patch.wavelength;
  options.seeds.assign(design.fresh_seeds.begin(), design.fresh_seeds.begin() + static_cast<std::ptrdiff_t>(draws));
  options.samples = 1U << 19;
  design.traced = verify_design(gray, problem.printer, *problem.lobes, options, progress);
  if (problem.by_light) design.fresh_lobe_error = design.traced->traced.by(LobeDistance::CubeRoot).root;
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

SlopeModel fresh_model(const DesignProblem& problem, const PrinterProfile& printer,
                       const std::vector<std::uint64_t>& seeds) {
  PatchOptions patch = problem.patch;
  patch.subsamples = std::min<std::size_t>(16, 2 * patch.subsamples);
  return {printer,
          patch,
          seeds,
          problem.lobes,
          {.levels = GrayLevels::Quantized, .drawn_ground = true, .place_x = 0.23, .place_y = 0.71}};
}

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
  if (problem.lobes) require_possible(*problem.lobes, brightness_slack);
  Design design;
  design.variables = search_variables(problem);
  const SearchPlan plan = plan_of(problem);
  std::optional<EvaluationLog> log;
  if (!problem.log.empty()) log.emplace(problem.log, problem.log_digest);
  design.search = search_pattern(goal, problem.pattern, design.variables, problem.printer, problem.patch, plan,
                                 log ? &*log : nullptr, progress);
  if (problem.by_light) {
    polish_traced(goal, problem.pattern, design.variables, problem.printer, problem.patch, plan, problem.traced,
                  log ? &*log : nullptr, design.search, progress);
  }
  design.pattern = with_values(problem.pattern, design.variables, design.search.values);
  design.warnings = design.search.warnings;

  const SlopeModel model(problem.printer, problem.patch, plan.seeds, problem.lobes);
  const auto searched = model.draws(design.pattern);
  design.on_search_draws = estimate_axes(covariances_of(searched));
  design.fresh_seeds = fresh_seeds(problem);
  const auto fresh = fresh_model(problem, problem.printer, design.fresh_seeds).draws(design.pattern);
  design.fresh_covariances = covariances_of(fresh);
  design.on_fresh_draws = estimate_axes(design.fresh_covariances);
  design.print_seed = closest_draw(problem, design);
  design.fresh_error = target_error(mean_of(design.fresh_covariances).mean, problem.target);
  judge(goal, searched, fresh, design);
  design.held_out_ratio = held_out_ratio(goal, design.search.lowered, searched, fresh, design);
  if (plan.seeds.size() >= 3 && fresh.size() >= 3) {
    design.intervals = parameter_intervals(goal, design.search.lowered, model, problem.pattern, design.variables,
                                           design.search.values, fresh, problem.target_draws);
  }
  trace_verdict(problem, design, progress);
  design.met = problem.by_light ? design.fresh_lobe_error && design.fresh_lobe_error->value <= problem.target.tolerance
                                : is_met(design.fresh_error, problem.target);
  warn_of_pixels(problem, design);
  warn_of_levels(problem, design);
  warn_of_lobes(problem, design);
  warn_of_bounds(design);
  warn_of_overfit(problem.target, design);
  return design;
}

}  // namespace mezzotint
