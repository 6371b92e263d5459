#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "forward/base/progress.h"
#include "inverse/design/lobe_goal.h"
#include "inverse/design/printed_texture.h"
#include "inverse/search/minimize.h"
#include "inverse/target/target.h"

namespace mezzotint {

/// A parameter that the search may change, by the name that the pattern's table gives it.
struct FreeParameter {
  std::string name;
  double low = 0.0;
  double high = 0.0;
  std::optional<double> start;  ///< left out: the closed-form start
};

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
  /// Given: the search lowers the cube-root error of the printed lobe, and `target.tolerance` is for that. Left
  /// out: it lowers the distance of the slope covariances, and the tolerance is for their variances.
  std::optional<LobeGoal> lobe;
};

/// What was found.
struct Design {
  Pattern pattern;
  std::vector<Variable> variables;
  std::vector<SearchStep> history;
  MinimizeResult search;
  SlopeAxesEstimate on_search_draws;  ///< gray levels continuous, the draws that were searched on
  SlopeAxesEstimate on_fresh_draws;   ///< quantised to the printer's levels, draws that the search never saw
  std::vector<SlopeCovariance> fresh_covariances;
  std::vector<std::uint64_t> fresh_seeds;
  /// The fresh draw to print: its own covariance is closest to the target's (with a lobe: to the mean's).
  std::uint64_t print_seed = 0;
  TargetError fresh_error;
  std::optional<Estimate> fresh_lobe_error;  ///< cube-root error on the fresh draws, where a lobe is the goal
  bool met = false;
  /// In words: saturated pixels, wavelengths under 4 pixels, a bound that was hit, an overfit to the search's draws.
  std::vector<std::string> warnings;
};

/// The parameters of the pattern whose print comes closest to the target.
///
/// Method   NLopt on `covariance_distance` of the mean covariance (or the cube-root error of the mean lobe) of
///          `search_draws` printed patches: pattern → gray → light → cure height → ground, with common random
///          numbers and continuous gray levels; the best point is evaluated again on `fresh_draws` other draws
///          with the printer's gray levels.
/// @throws InvalidInput for an impossible problem (unknown or whole parameter, bounds outside of its range, a composed
///         pattern: nothing of it can be searched yet).
[[nodiscard]] Design find_design(const DesignProblem& problem, const Progress& progress = {});

/// The problem's variables with their starts: explicit ones, closed-form ones cut to the bounds.
[[nodiscard]] std::vector<Variable> search_variables(const DesignProblem& problem);

/// Seeds of the draws: `search_seeds` and `fresh_seeds` never share one.
[[nodiscard]] std::vector<std::uint64_t> search_seeds(const DesignProblem& problem);
[[nodiscard]] std::vector<std::uint64_t> fresh_seeds(const DesignProblem& problem);

}  // namespace mezzotint
