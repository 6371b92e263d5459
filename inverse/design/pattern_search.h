#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "forward/base/progress.h"
#include "inverse/design/design_goal.h"
#include "inverse/search/evaluation_log.h"
#include "inverse/search/minimize.h"

namespace mezzotint {

/// How a search climbs from cheap models to the one that counts.
struct SearchPlan {
  MinimizeOptions search;  ///< of the local searches; `max_evaluations` counts evaluations on all draws, those on fewer
                           ///< count by their share. 0: the start is taken as it is
  MeasureSum objective;    ///< empty: chosen (see search_pattern)
  std::vector<std::uint64_t> seeds;  ///< of the draws: common random numbers
  std::size_t coarse_draws = 2;      ///< of them for the scan and the first local searches
  std::size_t scanned = 24;          ///< places that are looked at before the local searches
  std::size_t starts = 4;            ///< of the best of them, each with a local search
  int mapping_steps = 6;             ///< corrections of the moments' answer
  bool from_start = false;           ///< one local search on all draws from the variables' starts, and no more
};

/// One evaluation of a search.
struct DesignStep {
  std::string stage;  ///< "moments", "scan", "coarse 1" …, "fine", "position"
  SearchStep step;    ///< the objective is that of the stage
  double cost = 1.0;  ///< in evaluations on all draws
};

/// How a search ended.
struct SearchOutcome {
  std::vector<double> values;
  double objective = 0.0;  ///< of `lowered`, on all draws of the search
  MeasureSum lowered;      ///< what the last stage lowered
  std::vector<DesignStep> history;
  double cost = 0.0;       ///< in evaluations on all draws
  bool converged = false;  ///< false: the budget was used up
  std::string outcome;     ///< why it ended, in words
  /// The lobe's shape was found to be within the pattern's reach; true where none was asked for.
  bool shape_fits = true;
  bool at_noise_floor = false;  ///< what is left of the shape is what the draws' own scatter gives
  std::vector<std::string> warnings;
};

/// Searches a pattern's parameters on the ladder of models.
///
/// 1  Moments: the parameters whose closed-form moments are those of the target; corrected by what the slope model
/// shows
///    there (space mapping), until the slopes are right. A few evaluations, however many parameters.
/// 2  Where that is not enough (a shape is asked for, or the moments do not lead there): a scan of places spread over
/// the
///    box, each first moved to where its moments fit, all directions among them, the swap of the axes too; on few
///    draws and few samples.
/// 3  Local searches from the best of them, on few draws; then from the best on all draws.
/// 4  With an objective of its own choice: cube root and moments where the shape is within reach (the residual says
/// so),
///    else the position and width alone, since a search for a shape that cannot be had spoils both.
/// A global algorithm of NLopt, if one is named, does all of it by itself on all draws.
///
/// Best     the best that was seen is kept, whatever a search returns. An evaluation that fails counts as worse than
///          everything, and is told of.
/// @param log  every evaluation goes there, and those that it has are not made again; nullptr: none
/// @throws what `progress` throws; MethodError where no evaluation gave a finite objective.
[[nodiscard]] SearchOutcome search_pattern(const DesignGoal& goal, const Pattern& pattern,
                                           const std::vector<Variable>& variables, const PrinterProfile& printer,
                                           const PatchOptions& patch, const SearchPlan& plan, EvaluationLog* log,
                                           const Progress& progress = {});

}  // namespace mezzotint
