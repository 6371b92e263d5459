#pragma once

#include <cstdint>
#include <vector>

#include "forward/base/progress.h"
#include "inverse/design/pattern_search.h"

namespace mezzotint {

/// What tracing is spent on after a search by slopes.
///
/// Measured (design_race: targets traced, held-out error traced, light at 20°; five targets a family): a correction
/// takes a sinusoid's cube-root error from .020, .013, .012, .013, .012 to .013, .010, .012, .007, .013 for two thirds
/// more time, that of ridges with a sinusoid from .007, .024, .021, .040, .011 to .007, .024, .014, .037, .011 for a
/// third more; noise, lost in its draws' scatter, gets none. A polish of 40 evaluations more took .013 to .012 and .007
/// to .008, for as much time again: there is none by default.
struct TracedPlan {
  int corrections = 1;    ///< of the goal by what tracing shows, each followed by a search by slopes; 0 … 4
  int evaluations = 0;    ///< of a last search on traced light itself; 0: none
  std::size_t draws = 4;  ///< of the search's own, the same ones at every step
  std::uint64_t samples = 1U << 16;  ///< paths a draw and direction of the light
};

/// The last rungs of the search: what slopes alone leave out (shadows, further reflections, the printer's rounding),
/// put right by tracing.
///
/// Correction  the goal's maps plus what slopes show more than tracing does at the place found: a search by slopes for
///             that ends where tracing shows the goal. Kept where it is better as traced. None where the shape is out
///             of reach, or what is left is the draws' own scatter. None where the shape is out of the pattern's reach:
///             what is searched for then is the slopes alone, and the shape would get worse.
/// Polish      a short search on traced light, with common random numbers in pattern, ground and paths.
/// @param outcome  of search_pattern on a goal by its light; its values, objective (as traced), history and cost are
///                 changed. A traced evaluation costs as many of the slope model's as its time says (`traced_cost`).
void polish_traced(const DesignGoal& goal, const Pattern& pattern, const std::vector<Variable>& variables,
                   const PrinterProfile& printer, const PatchOptions& patch, const SearchPlan& plan,
                   const TracedPlan& traced, EvaluationLog* log, SearchOutcome& outcome, const Progress& progress = {});

/// What a traced evaluation is counted as, in evaluations of the slope model: measured at 96² to 192² pixels, two
/// directions of the light and 2^16 paths.
inline constexpr double traced_cost = 8.0;

}  // namespace mezzotint
