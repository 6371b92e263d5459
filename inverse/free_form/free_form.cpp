#include "inverse/free_form/free_form.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "forward/base/random.h"
#include "inverse/free_form/free_form_bench.h"
#include "inverse/free_form/free_form_starts.h"
#include "inverse/free_form/free_form_state.h"
#include "inverse/free_form/free_form_warnings.h"

namespace mezzotint {

namespace {

// Points of the relief a pixel and axis; their places change with each epoch. Three are cheap; steep parts need more.
constexpr std::size_t subsamples = 3, last_subsamples = 4;
constexpr std::size_t semifinalists = 4, finalists = 2;
constexpr std::size_t correction_draws = 2;
// Draws of places and grounds: for corrections, for the choice of a finalist, and for the verdict.
constexpr std::uint64_t correction_seed = std::uint64_t{1} << 23, choice_seed = std::uint64_t{1} << 24,
                        verdict_seed = std::uint64_t{1} << 25;
constexpr std::uint64_t seed_stride = std::uint64_t{1} << 32;

// What is done to a growth in one go.
struct Stage {
  bool correct = false;  // look by tracing what the model misses; otherwise improve
  std::vector<WeightedDistance> objective;
  bool counts = true;  // the objective is that of the whole search
  int evaluations = 0;
  std::uint64_t epoch = 0;
  std::size_t samples = subsamples;
};

class FreeFormSearch {
public:
  FreeFormSearch(const LobeTarget& goal, const PrinterProfile& printer, const FreeFormOptions& options,
                 const Progress& progress)
      : goal_(goal),
        printer_(printer),
        options_(options),
        progress_(progress),
        problem_(problem_digest(goal, printer, options)),
        fine_(model_bins(goal)) {}

  FreeForm run() {
    begin();
    for (std::size_t i = 0; i < state_.growths.size(); ++i) advance(i, trial_of(i));
    const std::vector<std::size_t> semi = best_of(better_trials(), 0, semifinalists);
    for (const std::size_t i : semi) advance(i, refinement_of(i, quarter()));
    const std::vector<std::size_t> best = best_of(semi, quarter(), finalists);
    std::vector<double> chosen_by;
    for (const std::size_t i : best) {
      advance(i, refinement_of(i, epochs()));
      const auto draws = traced(gray_of(state_.growths[i]), choice_seed, options_.fresh_draws);
      chosen_by.push_back(weighted_sum(options_.objective, judge_draws(draws, goal_)));
    }
    const auto chosen = static_cast<std::size_t>(std::ranges::min_element(chosen_by) - chosen_by.begin());
    return verdict(state_.growths[best[chosen]]);
  }

private:
  // From each start one trial by way of the Wasserstein distance, and one straight on.
  void begin() {
    if (!options_.state.empty() && std::filesystem::exists(options_.state)) {
      state_ = read_state(options_.state, problem_);
    } else {
      state_.pixels = options_.pixels;
      state_.best.after = {std::numeric_limits<double>::max()};
      for (const StartShape& shape : start_shapes(goal_, printer_, options_)) {
        for (int trial = 0; trial < 2; ++trial) {
          Growth growth;
          growth.start = shape.name;
          growth.wanted_um = shape.wanted_um;
          state_.growths.push_back(std::move(growth));
        }
      }
    }
    for (const Growth& growth : state_.growths) done_ += growth.evaluations;
    planned_ = 1.5 * static_cast<double>(state_.growths.size()) * options_.start_evaluations +
               static_cast<double>(finalists) * options_.evaluations +
               static_cast<double>((semifinalists - finalists) * quarter()) * options_.evaluations_per_epoch;
  }

  [[nodiscard]] std::vector<Stage> trial_of(std::size_t growth) const {
    const Stage straight{.objective = options_.start_objective, .evaluations = options_.start_evaluations};
    if (growth % 2 == 1) return {straight};
    Stage moved = straight;
    moved.objective = {{LobeDistance::Wasserstein, 1.0}};
    moved.counts = false;
    return {moved, straight};
  }

  [[nodiscard]] std::size_t epochs() const {
    return static_cast<std::size_t>((options_.evaluations + options_.evaluations_per_epoch - 1) /
                                    options_.evaluations_per_epoch);
  }
  [[nodiscard]] std::size_t quarter() const { return (epochs() + 3) / 4; }

  // The trial, then so many epochs, each with other places.
  [[nodiscard]] std::vector<Stage> refinement_of(std::size_t growth, std::size_t count) const {
    std::vector<Stage> stages = trial_of(growth);
    const auto corrections = static_cast<std::size_t>(options_.traced_corrections);
    std::size_t corrected = 0;
    int left = options_.evaluations;
    for (std::size_t epoch = 0; epoch < count; ++epoch) {
      // Spread over the second half.
      while (corrected < corrections && epoch >= (epochs() + 1) / 2 + corrected * (epochs() / 2) / corrections) {
        stages.push_back({.correct = true, .epoch = epoch + 1});
        ++corrected;
      }
      const int now = std::min(left, options_.evaluations_per_epoch);
      left -= now;
      stages.push_back({.objective = 3 * epoch < 2 * epochs() ? options_.start_objective : options_.objective,
                        .evaluations = now,
                        .epoch = epoch + 1,
                        .samples = 2 * epoch < epochs() ? subsamples : last_subsamples});
    }
    return stages;
  }

  // The stages that are not done yet; after each the state is on disk.
  void advance(std::size_t index, const std::vector<Stage>& stages) {
    Growth& growth = state_.growths[index];
    for (std::size_t next = growth.after.size(); next < stages.size(); ++next) {
      if (stages[next].correct)
        correct(growth, stages[next]);
      else
        improve(growth, stages[next]);
      keep();
    }
  }
  void keep() const {
    if (!options_.state.empty()) write_state(options_.state, problem_, state_);
  }

  // The objective that a growth had after its trial and so many epochs, none of which follows a correction.
  [[nodiscard]] double value_after(std::size_t index, std::size_t count) const {
    return state_.growths[index].after[trial_of(index).size() + count - 1];
  }
  // Of each start.
  [[nodiscard]] std::vector<std::size_t> better_trials() const {
    std::vector<std::size_t> better;
    for (std::size_t i = 0; i < state_.growths.size(); i += 2)
      better.push_back(value_after(i, 0) < value_after(i + 1, 0) ? i : i + 1);
    return better;
  }
  [[nodiscard]] std::vector<std::size_t> best_of(std::vector<std::size_t> growths, std::size_t epochs_done,
                                                 std::size_t count) const {
    std::ranges::stable_sort(growths, {}, [&](std::size_t i) { return value_after(i, epochs_done); });
    return {growths.begin(), growths.begin() + static_cast<std::ptrdiff_t>(std::min(growths.size(), count))};
  }

  [[nodiscard]] FreeFormBench bench(const Stage& stage) const {
    const auto place = RandomStream(options_.seed, RandomPurpose::SamplePlace).uniform4(stage.epoch);
    return {goal_, fine_, printer_, options_, {stage.samples, place[0], place[1]}};
  }
  [[nodiscard]] GrayImage gray_of(const Growth& growth) const {
    return gray_of_heights(growth.wanted_um, options_.pixels, printer_);
  }
  [[nodiscard]] std::vector<Variable> variables_of(const Growth& growth) const {
    const WantedHeights range = wanted_range(printer_);
    std::vector<Variable> variables;
    for (const double height : growth.wanted_um)
      variables.push_back({"height_um", range.low_um, range.high_um, std::clamp(height, range.low_um, range.high_um)});
    return variables;
  }

  void improve(Growth& growth, const Stage& stage) {
    const FreeFormBench bench_now = bench(stage);
    const double gamma = printer_.cure.gamma, beta_um = printer_.cure.beta.um();
    const auto objective = [&](const std::vector<double>& wanted_um, std::vector<double>& slopes) {
      const GrayImage gray = gray_of_heights(wanted_um, options_.pixels, printer_);
      std::vector<float> gray_slopes;
      const double value = bench_now.distance(stage.objective, growth.beyond, gray, gray_slopes);
      for (std::size_t i = 0; i < slopes.size(); ++i)
        slopes[i] = static_cast<double>(gray_slopes[i]) * (static_cast<double>(gray.values[i]) - gamma) / beta_um;
      return value;
    };
    std::vector<double> history;
    const auto observer = [&](int evaluation, const SearchStep& step) {
      ++done_;
      if (stage.counts) note(growth, step, growth.evaluations + evaluation, history);
      report(progress_, "free form", std::min(1.0, done_ / planned_),
             fmt::format("from {}: {:.2e}", growth.start, step.objective));
    };
    try {
      const MinimizeResult found = minimize_with_slopes(variables_of(growth), objective,
                                                        {.algorithm = options_.algorithm,
                                                         .max_evaluations = stage.evaluations,
                                                         .relative_tolerance = 1e-6,
                                                         .seed = options_.seed},
                                                        observer);
      growth.wanted_um = found.best.values;
      growth.after.push_back(found.best.objective);
      growth.evaluations += found.evaluations;
      growth.history.insert(growth.history.end(), history.begin(), history.end());
    } catch (...) {
      keep();  // the stage begins anew, but its best is not lost
      throw;
    }
  }

  void note(const Growth& growth, const SearchStep& step, int evaluations, std::vector<double>& history) {
    history.push_back(step.objective);
    if (!std::isfinite(step.objective) || step.objective >= last_of(state_.best)) return;
    state_.best.start = growth.start;
    state_.best.wanted_um = step.values;
    state_.best.after = {step.objective};
    state_.best.evaluations = evaluations;
  }

  // Lobes of prints of a gray image on fresh grounds.
  [[nodiscard]] std::vector<std::vector<DirectionMap>> traced(const GrayImage& gray, std::uint64_t first_seed,
                                                              std::size_t draws) const {
    std::vector<std::vector<DirectionMap>> lobes;
    std::vector<EnergyAudit> audits;
    for (std::uint64_t draw = 0; draw < draws; ++draw) {
      const std::uint64_t seed = options_.seed * seed_stride + first_seed + draw;
      const HeightField relief = print_draw(gray, printer_, draw_options(), seed);
      lobes.push_back(traced_lobes(relief, goal_, options_.traced_samples, 0.0, seed, audits, progress_));
    }
    return lobes;
  }
  [[nodiscard]] DrawOptions draw_options() const {
    return {.surround = Surround::Repeat, .wavelength = options_.wavelength};
  }

  void correct(Growth& growth, const Stage& stage) {
    const GrayImage gray = gray_of(growth);
    const auto draws = traced(gray, correction_seed + (stage.epoch << 8), correction_draws);
    growth.beyond = bench({.epoch = stage.epoch, .samples = 8}).lobes(gray);
    for (std::size_t light = 0; light < growth.beyond.size(); ++light) {
      for (std::size_t k = 0; k < growth.beyond[light].size(); ++k) {
        double seen = 0.0;
        for (const auto& draw : draws) seen += draw[light][k] / static_cast<double>(correction_draws);
        growth.beyond[light][k] = seen - growth.beyond[light][k];
      }
    }
    growth.after.push_back(last_of(growth));
  }

  [[nodiscard]] FreeForm verdict(const Growth& best) const {
    FreeForm found{.gray = quantize(gray_of(best), printer_),
                   .start = best.start,
                   .history = best.history,
                   .on_search_draws = last_of(best),
                   .evaluations = static_cast<int>(done_)};
    VerificationOptions fresh{.draw = draw_options(), .samples = options_.traced_samples};
    for (std::uint64_t draw = 0; draw < options_.fresh_draws; ++draw)
      fresh.seeds.push_back(options_.seed * seed_stride + verdict_seed + draw);
    const GrayOfSeed gray = [&found](std::uint64_t) { return found.gray; };
    found.verified = verify_design(gray, printer_, goal_, fresh, progress_);
    found.warnings = free_form_warnings(goal_, printer_, options_, found);
    return found;
  }

  const LobeTarget& goal_;
  const PrinterProfile& printer_;
  const FreeFormOptions& options_;
  const Progress& progress_;
  std::string problem_;
  SmoothGrid fine_;
  FreeFormState state_;
  double planned_ = 1.0, done_ = 0.0;
};

}  // namespace

FreeForm find_free_form(const LobeTarget& goal, const PrinterProfile& printer, const FreeFormOptions& options,
                        const Progress& progress) {
  require_valid_search(goal, options);
  require_valid(printer);
  return FreeFormSearch(goal, printer, options, progress).run();
}

std::optional<FreeFormSoFar> free_form_so_far(const std::filesystem::path& path, const PrinterProfile& printer) {
  const FreeFormState state = read_state(path, "");
  const Growth& best = state.best;
  if (best.wanted_um.empty()) return std::nullopt;
  if (best.wanted_um.size() != state.pixels * state.pixels)
    throw FileError(path, "", "holds a relief of another size than it says; delete it to start anew");
  int evaluations = 0;
  for (const Growth& growth : state.growths) evaluations += growth.evaluations;
  return FreeFormSoFar{quantize(gray_of_heights(best.wanted_um, state.pixels, printer), printer), best.start,
                       last_of(best), evaluations};
}

}  // namespace mezzotint
