#include "inverse/design/pattern_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "inverse/design/design_variables.h"
#include "inverse/design/expected_covariance.h"
#include "inverse/design/moments_start.h"
#include "inverse/verification/judge_draws.h"

namespace mezzotint {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// A shape counts as within reach where the cube-root residual is below this, or explained by the draws' own noise.
// Reachable lobes end at .02 to .03, unreachable ones above .1 (shared measurements of all families).
constexpr double residual_of_a_shape = 0.06;
// Nothing is gained by other starts from here on.
constexpr double residual_of_a_good_shape = 0.03;
constexpr int coarse_evaluations_per_variable = 12, fine_evaluations_per_variable = 15;

bool is_global(const std::string& algorithm) { return algorithm.starts_with("G"); }

const MeasureSum slopes_alone = {{Measure::SlopeCovariance, 1.0}};

// A model of some draws, and what it costs to ask it.
struct Level {
  SlopeModel model;
  double cost;
};

struct Place {
  std::vector<double> values;
  double objective = infinity;
};

struct Evaluation {
  double objective = std::numeric_limits<double>::quiet_NaN();
  SlopeCovariance covariance;
};

// Enough to tell valleys apart, with few draws: 1/σ samples a pixel (σ the Gaussian blur's width in pixels) hold all
// but a hundredth of the light's contrast. The cure curve's logarithm sharpens what it makes of it, so that a lobe may
// be off by a few per cent: the last searches take the patch's own samples, and so do searches for slopes alone.
PatchOptions coarse(PatchOptions patch, const PrinterProfile& printer) {
  if (printer.spread.kernel != PixelSpread::Kernel::Gaussian || printer.spread.width.um() <= 0.0) return patch;
  const double enough = std::max(2.0, std::ceil(printer.pixel_pitch / printer.spread.width - 1e-9));
  if (enough < static_cast<double>(patch.subsamples)) patch.subsamples = static_cast<std::size_t>(enough);
  return patch;
}

std::vector<std::uint64_t> first_of(const std::vector<std::uint64_t>& seeds, std::size_t count) {
  return {seeds.begin(), seeds.begin() + static_cast<std::ptrdiff_t>(std::min(count, seeds.size()))};
}

class PatternSearch {
public:
  PatternSearch(const DesignGoal& goal, const Pattern& pattern, const std::vector<Variable>& variables,
                const PrinterProfile& printer, const PatchOptions& patch, const SearchPlan& plan, EvaluationLog* log,
                const Progress& progress)
      : goal_(goal),
        pattern_(pattern),
        variables_(variables),
        pitch_(printer.pixel_pitch),
        plan_(plan),
        log_(log),
        progress_(progress),
        moments_(pattern, variables, printer, patch.wavelength),
        fine_{model_of(printer, patch, plan.seeds), 1.0},
        coarse_{model_of(printer, goal.by_light() ? coarse(patch, printer) : patch,
                         first_of(plan.seeds, plan.coarse_draws)),
                1.0} {
    coarse_.cost = coarse_.model.samples() / fine_.model.samples();
  }

  SearchOutcome run() {
    Place start;
    for (const Variable& variable : variables_) start.values.push_back(variable.start);
    const bool chooses = plan_.objective.empty();
    lowered_ = chooses ? (goal_.by_light() ? shape_and_width() : slopes_alone) : plan_.objective;
    if (plan_.search.max_evaluations == 0) return without_a_search(start);
    if (is_global(plan_.search.algorithm))
      return finish(search_from("global", fine_, start, plan_.search.initial_step, 0));

    Place best = by_moments(start);
    if (is_enough(best)) return finish(best);
    const Place shaped = by_shape(best);
    if (!std::isfinite(shaped.objective)) return with_slopes_alone(best);
    if (!asks_for_shape()) return finish(shaped);
    return finish(shape_fits(shaped) ? with_exact_slopes(shaped) : by_position(shaped));
  }

private:
  // Slopes alone need no maps; by the adjoint, they are those of the draws.
  [[nodiscard]] SlopeModel model_of(const PrinterProfile& printer, const PatchOptions& patch,
                                    const std::vector<std::uint64_t>& seeds) const {
    const auto& sum = plan_.objective;
    const bool needs_maps = goal_.by_light() || std::ranges::any_of(sum, [](const WeightedMeasure& term) {
                              return lobe_distance_of(term.measure).has_value();
                            });
    return {printer, patch, seeds, needs_maps ? goal_.lobes() : std::nullopt, {.to_expectation = !wants_slopes()}};
  }

  // The slopes that the light implies can be freed of what the draws are off by; moments of the light have derivatives.
  [[nodiscard]] MeasureSum shape_and_width() const {
    const bool random = smooth_expectation(pattern_, pitch_).has_value() && !wants_slopes();
    return {{Measure::CubeRoot, 1.0}, {random ? Measure::SlopeCovariance : Measure::Moments, 1.0}};
  }

  // ---- asking a model

  Evaluation ask(const std::string& stage, const Level& level, const MeasureSum& sum,
                 const std::vector<double>& values) {
    Evaluation evaluation;
    const auto earlier = log_ != nullptr ? log_->replay(stage, values) : std::nullopt;
    if (earlier) {
      evaluation = {earlier->at(0), {earlier->at(1), earlier->at(2), earlier->at(3)}};
    } else {
      evaluation = made(level, sum, values);
      const SlopeCovariance& c = evaluation.covariance;
      if (log_ != nullptr) log_->append({stage, values, {evaluation.objective, c.xx, c.yy, c.xy}});
    }
    note(stage, values, evaluation.objective, level.cost);
    return evaluation;
  }

  // The same with slopes, for the cost of about three.
  double ask_with_slopes(const std::string& stage, const Level& level, const std::vector<double>& values,
                         std::vector<double>& slopes) {
    const auto earlier = log_ != nullptr ? log_->replay(stage, values) : std::nullopt;
    double objective = 0.0;
    if (earlier) {
      objective = earlier->at(0);
      slopes.assign(earlier->begin() + 1, earlier->end());
    } else {
      objective = made_with_slopes(level, values, slopes);
      if (log_ != nullptr) {
        std::vector<double> results = {objective};
        results.insert(results.end(), slopes.begin(), slopes.end());
        log_->append({stage, values, results});
      }
    }
    note(stage, values, objective, 3.0 * level.cost);
    return objective;
  }

  double made_with_slopes(const Level& level, const std::vector<double>& values, std::vector<double>& slopes) {
    std::vector<std::string> names;
    for (const Variable& variable : variables_) names.push_back(variable.name);
    const auto figure = [this](const SlopeModel::Shown& shown, SlopeModel::Shown& toward) {
      return goal_.distance_with_slopes(lowered_, shown, toward);
    };
    return guarded(
        [&] {
          return level.model.figure_with_slopes(with_values(pattern_, variables_, values), names, figure, slopes);
        },
        std::numeric_limits<double>::quiet_NaN());
  }

  void note(const std::string& stage, const std::vector<double>& values, double objective, double cost) {
    spent_ += cost;
    outcome_.history.push_back({stage, {values, objective}, cost});
    if (std::isfinite(objective)) last_ = objective;
    if (progress_) report(progress_, "search", std::min(1.0, spent_ / plan_.search.max_evaluations), in_words(stage));
  }

  Evaluation made(const Level& level, const MeasureSum& sum, const std::vector<double>& values) {
    return guarded(
        [&]() -> Evaluation {
          const SlopeModel::Shown shown = level.model.shown(with_values(pattern_, variables_, values));
          return {goal_.distance(sum, shown), goal_.covariance(shown)};
        },
        Evaluation{});
  }

  // An evaluation that cannot be made counts as worse than all others, and is told of at the end.
  template <typename Make, typename Result>
  Result guarded(const Make& make, Result failed) {
    try {
      const Result result = make();
      if (is_finite(result)) return result;
      failure_ = "the objective is not a finite number";
    } catch (const InvalidInput& error) {
      failure_ = error.what();
    } catch (const MethodError& error) {
      failure_ = error.what();
    }
    ++failures_;
    return failed;
  }

  static bool is_finite(double objective) { return std::isfinite(objective); }
  static bool is_finite(const Evaluation& evaluation) { return std::isfinite(evaluation.objective); }

  [[nodiscard]] std::string in_words(const std::string& stage) const {
    return fmt::format("{}: {:.0f} evaluations, distance {:.2e}", stage, spent_, last_);
  }

  [[nodiscard]] int affordable(const Level& level) const {
    return static_cast<int>((plan_.search.max_evaluations - spent_) / level.cost + 1e-9);
  }

  // ---- rung 1: moments, corrected

  // Slopes that are right to a tenth of what is asked for.
  [[nodiscard]] double slopes_good_enough() const {
    const double tolerance = is_judged(goal_.target()) ? std::min(goal_.target().tolerance, 0.05) : 0.05;
    return std::pow(0.1 * tolerance, 2);
  }

  [[nodiscard]] Target at_rotation_of(const SlopeCovariance& shown) const {
    Target target = goal_.target();
    if (!target.rotation_matters) target.slopes.rotation = principal_axes(shown).rotation;
    return target;
  }

  Place by_moments(const Place& start) {
    if (!moments_.exists()) return start;
    return map_space("moments", {moments_.solve(goal_.target(), start.values), infinity});
  }

  // Lowers the distance of the slopes alone; the best place by that.
  Place map_space(const std::string& stage, Place from) {
    Place best = from;
    for (int step = 0; step < plan_.mapping_steps && affordable(fine_) > 0; ++step) {
      const Evaluation shown = ask(stage, fine_, slopes_alone, from.values);
      if (!std::isfinite(shown.objective)) break;
      const bool better = shown.objective < best.objective;
      if (better) best = {from.values, shown.objective};
      if (best.objective <= slopes_good_enough() || (!better && step > 1)) break;
      Target asked = at_rotation_of(shown.covariance);
      const SlopeCovariance wanted = covariance_of(asked.slopes);
      asked.slopes = principal_axes(mapped(moments_.covariance(from.values), shown.covariance, wanted));
      from.values = moments_.solve(asked, from.values);
      if (from.values == best.values) break;
    }
    return best;
  }

  [[nodiscard]] bool is_enough(const Place& place) const {
    return lowered_.size() == 1 && lowered_.front().measure == Measure::SlopeCovariance &&
           place.objective <= slopes_good_enough();
  }

  // ---- rungs 2 and 3: scan, local searches

  // Another round of starts only where the first ends at a shape that does not fit: a pattern of several waves has
  // several valleys.
  Place by_shape(const Place& position) {
    const std::vector<Place> places = scan(position);
    const int most = fine_evaluations_per_variable * static_cast<int>(variables_.size());
    Place best{position.values, infinity};
    for (std::size_t first = 0; first < std::min(2 * plan_.starts, places.size()); first += plan_.starts) {
      const Place coarse = best_of_starts(places, first);
      if (first > 0 && !std::isfinite(coarse.objective)) break;
      const Place fine = search_from("fine", fine_, coarse, 0.3 * plan_.search.initial_step, most);
      if (fine.objective < best.objective) best = fine;
      if (!asks_for_shape() || !std::isfinite(best.objective) || shape_fits(best)) break;
    }
    return best;
  }

  Place best_of_starts(const std::vector<Place>& places, std::size_t first) {
    Place best{places[first].values, infinity};
    for (std::size_t i = first; i < std::min(first + plan_.starts, places.size()); ++i) {
      const int most = coarse_evaluations_per_variable * static_cast<int>(variables_.size());
      const Place found =
          search_from(fmt::format("coarse {}", i + 1), coarse_, places[i], plan_.search.initial_step, most);
      if (found.objective < best.objective) best = found;
      if (asks_for_shape() && best.objective <= std::pow(residual_of_a_good_shape, 2)) break;
    }
    return best;
  }

  [[nodiscard]] bool asks_for_shape() const { return plan_.objective.empty() && goal_.by_light(); }

  // The best places first.
  std::vector<Place> scan(const Place& position) {
    std::vector<std::vector<double>> values = {position.values};
    for (const std::vector<double>& point : spread_points(variables_, plan_.scanned, plan_.search.seed))
      values.push_back(moments_.exists() ? moments_.solve(goal_.target(), point) : point);
    add_swapped_axes(position, values);
    std::vector<Place> places;
    for (std::vector<double>& point : values) {
      if (affordable(coarse_) < 1) break;
      const double objective = ask("scan", coarse_, lowered_, point).objective;
      places.push_back({std::move(point), std::isfinite(objective) ? objective : infinity});
    }
    std::ranges::stable_sort(places, {}, &Place::objective);
    return places;
  }

  void add_swapped_axes(const Place& position, std::vector<std::vector<double>>& values) const {
    for (const double turn : {90.0, 45.0}) {
      std::vector<double> turned = position.values;
      for (std::size_t i = 0; i < turned.size(); ++i) {
        if (!is_axis(variables_[i])) continue;
        turned[i] += turned[i] + turn <= variables_[i].high ? turn : -turn;
        turned[i] = std::clamp(turned[i], variables_[i].low, variables_[i].high);
      }
      if (turned != position.values) values.push_back(std::move(turned));
    }
  }

  // A local search by the user's algorithm. `most` 0: all that is left.
  Place search_from(const std::string& stage, const Level& level, const Place& from, double step, int most) {
    const int budget = most > 0 ? std::min(most, affordable(level)) : affordable(level);
    if (budget < 1) return from;
    std::vector<Variable> variables = variables_;
    for (std::size_t i = 0; i < variables.size(); ++i) variables[i].start = from.values[i];
    MinimizeOptions options = plan_.search;
    options.max_evaluations = budget;
    options.initial_step = step;
    // Where the last figures are decided: a thousandth of half a turn is a fifth of a degree.
    if (level.cost == 1.0) options.relative_tolerance *= 0.2;
    if (lowered_.size() == 1 && lowered_.front().measure == Measure::SlopeCovariance)
      options.good_enough = slopes_good_enough();
    try {
      const MinimizeResult found = by_slopes() ? minimize_with_slopes(variables, steep(stage, level), options)
                                               : minimize(variables, plain(stage, level), options);
      words_ = found.outcome;
      converged_ = found.converged;
      return {found.best.values, found.best.objective};
    } catch (const MethodError& error) {  // not one finite objective from here; another start may do better
      failure_ = failure_.empty() ? error.what() : failure_;
      return {from.values, infinity};
    }
  }

  [[nodiscard]] Objective plain(const std::string& stage, const Level& level) {
    return [this, stage, &level](const std::vector<double>& values) {
      return ask(stage, level, lowered_, values).objective;
    };
  }

  // Algorithms that take slopes get them by the adjoint, where the goal has them.
  [[nodiscard]] bool wants_slopes() const { return plan_.search.algorithm.find("D_") == 1; }
  [[nodiscard]] bool by_slopes() const { return wants_slopes() && goal_.has_slopes(lowered_); }
  [[nodiscard]] SteepObjective steep(const std::string& stage, const Level& level) {
    return [this, stage, &level](const std::vector<double>& values, std::vector<double>& slopes) {
      return ask_with_slopes(stage, level, values, slopes);
    };
  }

  // ---- rung 4: is the shape within reach?

  bool shape_fits(const Place& place) {
    const std::vector<SlopeModel::Shown> draws = fine_.model.draws(with_values(pattern_, variables_, place.values));
    std::vector<std::vector<DirectionMap>> maps;
    for (const SlopeModel::Shown& draw : draws) maps.push_back(draw.maps);
    // The draws' own scatter is told from a misfit where there are enough of them.
    const double floor =
        draws.size() < 4 ? 0.0 : judge_draws(maps, *goal_.lobes()).by(LobeDistance::CubeRoot).floor.value;
    const double residual = goal_.distance(Measure::CubeRoot, mean_of(draws));
    outcome_.at_noise_floor = residual <= 2.0 * floor;
    outcome_.shape_fits = residual <= std::pow(residual_of_a_shape, 2) + 4.0 * floor;
    return outcome_.shape_fits;
  }

  // The cube root of a noisy lobe is off to one side: the slopes are put right once more by the moments, from where the
  // shape is found, if the shape bears it.
  Place with_exact_slopes(const Place& shaped) {
    if (!moments_.exists() || affordable(fine_) < 2) return shaped;
    const Place exact = map_space("position", {shaped.values, infinity});
    if (!std::isfinite(exact.objective) || affordable(fine_) < 1) return shaped;
    const double objective = ask("fine", fine_, lowered_, exact.values).objective;
    return objective <= 1.3 * shaped.objective ? Place{exact.values, objective} : shaped;
  }

  // Position and width alone, from the place whose shape came nearest.
  Place by_position(const Place& from) {
    if (affordable(fine_) < 1) {
      outcome_.warnings.emplace_back(
          "the lobe's shape was not met when the budget ended, and position and widths alone could not be searched: "
          "this is the best so far; allow more evaluations");
      converged_ = false;
      return from;
    }
    outcome_.warnings.push_back(
        "the pattern cannot have the lobe's shape: its position and widths alone were searched to the end, since a "
        "search for the shape would spoil them");
    lowered_ = slopes_alone;
    Place best = moments_.exists() ? map_space("position", {from.values, infinity}) : Place{from.values, infinity};
    if (is_enough(best)) return best;
    const Place found = search_from("position", fine_, best, 0.3 * plan_.search.initial_step, 0);
    return found.objective < best.objective ? found : best;
  }

  // ---- the end

  SearchOutcome without_a_search(const Place& start) {
    words_ = "no evaluation was allowed: this is the start, by closed forms, as it is";
    converged_ = false;
    outcome_.warnings.push_back(words_);
    outcome_.values = moments_.exists() ? moments_.solve(goal_.target(), start.values) : start.values;
    return end(std::numeric_limits<double>::quiet_NaN());
  }

  SearchOutcome with_slopes_alone(const Place& best) {
    if (std::isfinite(best.objective)) {
      outcome_.warnings.emplace_back(
          failures_ > 0 ? "the objective gave no finite number anywhere; this is where the slopes alone led"
                        : "the budget ended before the objective could be searched; this is where the slopes alone "
                          "led: allow more evaluations");
      lowered_ = slopes_alone;
      converged_ = false;
    }
    return finish(best);
  }

  SearchOutcome finish(const Place& best) {
    if (!std::isfinite(best.objective)) {
      throw MethodError(fmt::format("the search made {} evaluations and none gave a finite objective{}",
                                    outcome_.history.size(), failure_.empty() ? "" : ": " + failure_));
    }
    if (words_.empty()) words_ = "the slopes are as near as was asked for";
    outcome_.values = best.values;
    return end(best.objective);
  }

  SearchOutcome end(double objective) {
    if (failures_ > 0) {
      outcome_.warnings.push_back(
          fmt::format("{} of {} evaluations failed and counted as worse than all others; the "
                      "last: {}",
                      failures_, outcome_.history.size(), failure_));
    }
    warn_of_flatness();
    outcome_.objective = objective;
    outcome_.lowered = lowered_;
    outcome_.cost = spent_;
    outcome_.converged = converged_;
    outcome_.outcome = words_;
    report(progress_, "search", 1.0, fmt::format("{:.0f} evaluations, {}", spent_, words_));
    return std::move(outcome_);
  }

  // Every place alike: nothing that may change matters. A scan sees the whole box, and a search what is around it.
  void warn_of_flatness() {
    if (!is_flat("scan", 1e-3) && !is_flat(outcome_.history.empty() ? "" : outcome_.history.back().stage, 1e-9)) return;
    outcome_.warnings.emplace_back(
        "the objective is the same wherever the search looked: what it may change does not show, or is lost under "
        "the printer's ground; free another parameter or widen the bounds");
  }

  [[nodiscard]] bool is_flat(const std::string& stage, double share) const {
    double low = infinity, high = -infinity;
    std::size_t count = 0;
    for (const DesignStep& step : outcome_.history) {
      if (step.stage != stage || !std::isfinite(step.step.objective)) continue;
      low = std::min(low, step.step.objective);
      high = std::max(high, step.step.objective);
      ++count;
    }
    return count >= 2 * variables_.size() + 1 && high - low <= share * std::abs(high);
  }

  const DesignGoal& goal_;
  const Pattern& pattern_;
  const std::vector<Variable>& variables_;
  Length pitch_;
  const SearchPlan& plan_;
  EvaluationLog* log_;
  const Progress& progress_;
  MomentsModel moments_;
  Level fine_, coarse_;
  MeasureSum lowered_;
  SearchOutcome outcome_;
  double spent_ = 0.0, last_ = std::numeric_limits<double>::quiet_NaN();
  int failures_ = 0;
  std::string failure_, words_;
  bool converged_ = true;
};

}  // namespace

SearchOutcome search_pattern(const DesignGoal& goal, const Pattern& pattern, const std::vector<Variable>& variables,
                             const PrinterProfile& printer, const PatchOptions& patch, const SearchPlan& plan,
                             EvaluationLog* log, const Progress& progress) {
  require(!variables.empty(), "a search needs at least one free parameter");
  for (const WeightedMeasure& term : plan.objective)
    require(std::isfinite(term.weight) && term.weight > 0.0, "weights of an objective must be finite and positive");
  return PatternSearch(goal, pattern, variables, printer, patch, plan, log, progress).run();
}

}  // namespace mezzotint
