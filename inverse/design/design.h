#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "forward/base/progress.h"
#include "inverse/design/design_variables.h"
#include "inverse/design/parameter_intervals.h"
#include "inverse/design/pattern_search.h"
#include "inverse/design/printed_texture.h"
#include "inverse/design/traced_polish.h"
#include "inverse/target/target.h"
#include "inverse/verification/verification.h"

namespace mezzotint {

/// Everything that a search needs to know.
struct DesignProblem {
  Target target;
  Pattern pattern;  ///< kind, and the values of what is not free
  std::vector<FreeParameter> free;
  PrinterProfile printer;
  PatchOptions patch;
  std::size_t search_draws = 8;  ///< draws whose mean covariance the search sees, the same ones at every step
  std::size_t fresh_draws = 12;  ///< other draws, on which the result is judged
  MinimizeOptions search;
  MeasureSum objective;             ///< what the search lowers; empty: it chooses (search_pattern)
  std::optional<LobeTarget> lobes;  ///< the lobes to show; left out: none is compared
  /// The lobes are what is wanted, and `target.tolerance` is for their cube-root error; else the slopes are, and it is
  /// for their variances.
  bool by_light = false;
  TracedPlan traced;               ///< the last rungs, for a problem by light
  std::size_t traced_draws = 4;    ///< fresh draws that are traced for the verdict; 0: none
  double target_draws = HUGE_VAL;  ///< how many draws of the patch a measured target stands for (its area)
  std::filesystem::path log;       ///< of all evaluations, to go on from; empty: none
  std::string log_digest;          ///< stands for all of the problem in the log, which is refused for another
};

/// What was found.
struct Design {
  Pattern pattern;
  std::vector<Variable> variables;
  SearchOutcome search;
  SlopeAxesEstimate on_search_draws;  ///< gray levels continuous, the draws that were searched on
  SlopeAxesEstimate on_fresh_draws;   ///< quantised to the printer's levels, draws that the search never saw
  std::vector<SlopeCovariance> fresh_covariances;
  std::vector<std::uint64_t> fresh_seeds;
  /// The fresh draw to print: its own covariance is closest to the target's (with a lobe: to the mean's).
  std::uint64_t print_seed = 0;
  TargetError fresh_error;
  /// Every distance of the lobes: on the search's own draws (gray levels continuous, the mean ground), on the fresh
  /// ones as printed, both by slopes alone; and on some of those traced. None without lobes.
  std::optional<LobeJudgement> on_search_lobes, on_fresh_lobes;
  std::optional<Verification> traced;
  /// Held-out ÷ trained, of the root of what was lowered; above 1.3 the search fitted its draws.
  double held_out_ratio = 1.0;
  ParameterIntervals intervals;
  std::optional<Estimate> fresh_lobe_error;  ///< √ of the cube root's on the fresh draws, of a lobe target
  bool met = false;
  /// In words: saturated pixels, wavelengths under 4 pixels, few gray levels, a bound that was hit, an overfit to the
  /// search's draws, light that no relief of the material sends back, slopes that a GGX lobe does not have.
  std::vector<std::string> warnings;
};

/// The parameters of the pattern whose print comes closest to the target: search_pattern, then judged on draws that it
/// has not seen, with the printer's gray levels and real draws of its ground.
/// @throws InvalidInput for an impossible problem (unknown or whole parameter, bounds outside of its range, lobes that
///         are dark, not finite or brighter than a mirror); FileError for a log that belongs to another; what
///         `progress` throws. With a log it can go on then.
[[nodiscard]] Design find_design(const DesignProblem& problem, const Progress& progress = {});

/// Draws of a problem's patch as they are printed, for verdicts: finer samples at other places than the search's, the
/// printer's levels, a ground of their own.
[[nodiscard]] SlopeModel fresh_model(const DesignProblem& problem, const PrinterProfile& printer,
                                     const std::vector<std::uint64_t>& seeds);

/// The problem's variables with their starts.
[[nodiscard]] std::vector<Variable> search_variables(const DesignProblem& problem);

/// Seeds of the draws: `search_seeds` and `fresh_seeds` never share one.
[[nodiscard]] std::vector<std::uint64_t> search_seeds(const DesignProblem& problem);
[[nodiscard]] std::vector<std::uint64_t> fresh_seeds(const DesignProblem& problem);

}  // namespace mezzotint
