#include "inverse/design/traced_polish.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "forward/base/error.h"
#include "inverse/design/design_variables.h"
#include "inverse/verification/verification.h"

namespace mezzotint {

namespace {

class TracedPolish {
public:
  TracedPolish(const DesignGoal& goal, const Pattern& pattern, const std::vector<Variable>& variables,
               const PrinterProfile& printer, const PatchOptions& patch, const SearchPlan& plan,
               const TracedPlan& traced, EvaluationLog* log, SearchOutcome& outcome, const Progress& progress)
      : goal_(goal),
        pattern_(pattern),
        variables_(variables),
        printer_(printer),
        patch_(patch),
        plan_(plan),
        traced_(traced),
        log_(log),
        outcome_(outcome),
        progress_(progress) {
    const std::size_t draws = std::min(traced.draws, plan.seeds.size());
    seeds_.assign(plan.seeds.begin(), plan.seeds.begin() + static_cast<std::ptrdiff_t>(draws));
  }

  void run() {
    // Out of reach, or lost in the draws' scatter: a correction would follow noise.
    const int corrections = outcome_.shape_fits && !outcome_.at_noise_floor ? traced_.corrections : 0;
    if (corrections == 0 && traced_.evaluations == 0) return;
    outcome_.objective = asked("traced", outcome_.values);
    for (int step = 0; step < corrections; ++step) {
      const std::vector<double> corrected = correct();
      const double objective = asked("traced", corrected);
      if (!(objective < outcome_.objective)) break;
      outcome_.values = corrected;
      outcome_.objective = objective;
    }
    if (traced_.evaluations > 0) polish();
  }

private:
  // Those of the last place are kept: a correction asks for them again.
  const std::vector<DirectionMap>& traced_maps(const std::vector<double>& values) {
    if (values != seen_) {
      maps_ = trace(values);
      seen_ = values;
    }
    return maps_;
  }

  [[nodiscard]] std::vector<DirectionMap> trace(const std::vector<double>& values) const {
    const Pattern pattern = with_values(pattern_, variables_, values);
    std::vector<SlopeModel::Shown> draws(seeds_.size());
    const DrawOptions options{.subsamples = std::max<std::size_t>(4, patch_.subsamples),
                              .wavelength = patch_.wavelength};
    tbb::parallel_for(std::size_t{0}, seeds_.size(), [&](std::size_t i) {
      const GrayImage gray =
          expose(pixel_heights(draw_instance(pattern, seeds_[i]), printer_, patch_.pixels), printer_).image;
      std::vector<EnergyAudit> audits;
      draws[i].maps = traced_lobes(print_draw(gray, printer_, options, seeds_[i]), *goal_.lobes(), traced_.samples, 0.0,
                                   seeds_[i], audits);
    });
    return mean_of(draws).maps;
  }

  // The traced objective, from the log where that has it.
  double asked(const std::string& stage, const std::vector<double>& values) {
    report(progress_, "search", 1.0, fmt::format("{}: {:.0f} evaluations", stage, outcome_.cost));
    const auto earlier = log_ != nullptr ? log_->replay(stage, values) : std::nullopt;
    const double objective = earlier ? earlier->at(0) : goal_.distance(outcome_.lowered, {{}, traced_maps(values)});
    if (!earlier && log_ != nullptr) log_->append({stage, values, {objective}});
    outcome_.history.push_back({stage, {values, objective}, traced_cost});
    outcome_.cost += traced_cost;
    return objective;
  }

  std::vector<double> correct() {
    LobeTarget lobes = *goal_.lobes();
    const std::vector<DirectionMap> traced = traced_maps(outcome_.values);
    // Of the same draws: their own scatter is in both, and so not in the difference.
    const std::vector<DirectionMap> by_slopes =
        SlopeModel(printer_, patch_, seeds_, lobes).shown(with_values(pattern_, variables_, outcome_.values)).maps;
    for (std::size_t light = 0; light < lobes.maps.size(); ++light) {
      for (std::size_t k = 0; k < lobes.maps[light].size(); ++k)
        lobes.maps[light][k] = std::max(0.0, lobes.maps[light][k] + by_slopes[light][k] - traced[light][k]);
    }
    std::vector<Variable> variables = variables_;
    for (std::size_t i = 0; i < variables.size(); ++i) variables[i].start = outcome_.values[i];
    SearchPlan plan = plan_;
    plan.from_start = true;
    plan.objective = outcome_.lowered;
    plan.search.max_evaluations = 4 * static_cast<int>(variables.size());
    const SearchOutcome found = search_pattern(DesignGoal(goal_.target(), lobes, true), pattern_, variables, printer_,
                                               patch_, plan, log_, progress_);
    outcome_.history.insert(outcome_.history.end(), found.history.begin(), found.history.end());
    outcome_.cost += found.cost;
    return found.values;
  }

  void polish() {
    std::vector<Variable> variables = variables_;
    for (std::size_t i = 0; i < variables.size(); ++i) variables[i].start = outcome_.values[i];
    MinimizeOptions options = plan_.search;
    options.max_evaluations = traced_.evaluations;
    options.initial_step = 0.05 * plan_.search.initial_step;
    const MinimizeResult found = minimize(
        variables, [&](const std::vector<double>& values) { return asked("polish", values); }, options);
    if (!(found.best.objective < outcome_.objective)) return;
    outcome_.values = found.best.values;
    outcome_.objective = found.best.objective;
  }

  const DesignGoal& goal_;
  const Pattern& pattern_;
  const std::vector<Variable>& variables_;
  const PrinterProfile& printer_;
  const PatchOptions& patch_;
  const SearchPlan& plan_;
  const TracedPlan& traced_;
  EvaluationLog* log_;
  SearchOutcome& outcome_;
  const Progress& progress_;
  std::vector<std::uint64_t> seeds_;
  std::vector<double> seen_;
  std::vector<DirectionMap> maps_;
};

}  // namespace

void polish_traced(const DesignGoal& goal, const Pattern& pattern, const std::vector<Variable>& variables,
                   const PrinterProfile& printer, const PatchOptions& patch, const SearchPlan& plan,
                   const TracedPlan& traced, EvaluationLog* log, SearchOutcome& outcome, const Progress& progress) {
  require(goal.by_light(), "tracing puts light right; a goal of slopes has none");
  require(traced.corrections >= 0 && traced.corrections <= 4, "a search takes 0 to 4 traced corrections");
  TracedPolish(goal, pattern, variables, printer, patch, plan, traced, log, outcome, progress).run();
}

}  // namespace mezzotint
