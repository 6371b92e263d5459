#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "forward/base/progress.h"
#include "inverse/minimize.h"
#include "inverse/printed_texture.h"
#include "inverse/target.h"

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
  std::uint64_t print_seed = 0;  ///< the fresh draw whose own covariance is closest to the target: the one to print
  TargetError fresh_error;
  bool met = false;
  /// In words: saturated pixels, wavelengths under 4 pixels, a bound that was hit, an overfit to the search's draws.
  std::vector<std::string> warnings;
};

/// The parameters of the printed pattern whose slope covariance comes closest to the target's.
///
/// Method   NLopt on `covariance_distance` of the mean covariance of `search_draws` printed patches: pattern →
///          gray → light → cure height → ground, with common random numbers and continuous gray levels; the
///          best point is evaluated again on `fresh_draws` other draws with the printer's gray levels.
/// @throws InvalidInput for an impossible problem (unknown parameter, bounds outside of its range).
[[nodiscard]] Design find_design(const DesignProblem& problem, const Progress& progress = {});

/// The problem's variables with their starts: explicit ones, closed-form ones cut to the bounds.
[[nodiscard]] std::vector<Variable> search_variables(const DesignProblem& problem);

/// Seeds of the draws: `search_seeds` and `fresh_seeds` never share one.
[[nodiscard]] std::vector<std::uint64_t> search_seeds(const DesignProblem& problem);
[[nodiscard]] std::vector<std::uint64_t> fresh_seeds(const DesignProblem& problem);

}  // namespace mezzotint
