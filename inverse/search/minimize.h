#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace mezzotint {

/// One variable of a search. Logarithmic ones are stepped by factors; both bounds are then positive.
struct Variable {
  std::string name;
  double low = 0.0;
  double high = 1.0;
  double start = 0.5;
  bool logarithmic = false;
};

struct MinimizeOptions {
  /// NLopt's own name, as in its manual: "LN_BOBYQA", "LN_SBPLX", "GN_DIRECT_L", "LD_SLSQP", … Those that want
  /// gradients get central differences (each counts two evaluations a variable); MLSL and AUGLAG get
  /// LN_BOBYQA as their local search.
  std::string algorithm = "LN_BOBYQA";
  int max_evaluations = 300;
  double relative_tolerance = 1e-3;  ///< of the variables, in the search's own (logarithmic) scale
  double initial_step = 0.1;         ///< share of each variable's range that the first steps take
  double good_enough = -HUGE_VAL;    ///< an objective below it ends the search
  std::uint64_t seed = 1;            ///< for NLopt's random algorithms
};

/// One call of the objective.
struct SearchStep {
  std::vector<double> values;  ///< in the variables' own units
  double objective = 0.0;
};

struct MinimizeResult {
  SearchStep best;  ///< the lowest finite objective that was seen, whatever the algorithm returns
  int evaluations = 0;
  int not_finite = 0;      ///< of them, whose objective, or a slope of it, was not finite
  std::string outcome;     ///< why it ended, in words; where every place gave the same, that
  bool converged = false;  ///< not by the budget, nor on a flat objective
};

/// Called with the variables' values; may throw, which ends the search and reaches the caller unchanged.
using Objective = std::function<double(const std::vector<double>&)>;
/// The same, which also sets its slope toward every value, in the values' own units. (One slope a value is there.)
using SteepObjective = std::function<double(const std::vector<double>& values, std::vector<double>& slopes)>;
/// Called after each evaluation with its number and what it gave; may throw to stop.
using SearchObserver = std::function<void(int evaluation, const SearchStep&)>;

/// Whether NLopt knows an algorithm of that name (and it can be used alone).
[[nodiscard]] bool is_known_algorithm(const std::string& name);

/// Minimises by NLopt.
///
/// NLopt is wrapped because an exception in an objective comes back as a bare "nlopt failure", some algorithms
/// go on calling after it, COBYLA returns its last point rather than its best, and its random state is
/// global to the thread: so the best point is kept here, exceptions are caught at the border and rethrown,
/// the seed is set in this thread, and an objective that is not finite counts as worse than everything.
/// @throws InvalidInput for an unknown algorithm (naming close ones), no variables, or bounds without room.
/// @throws MethodError where not one evaluation gave a finite objective, or none was made at all: some algorithms
/// refuse
///         one variable, or many, before they ask.
[[nodiscard]] MinimizeResult minimize(const std::vector<Variable>& variables, const Objective& objective,
                                      const MinimizeOptions& options, const SearchObserver& observer = {});

/// The same with slopes of the objective's own, for thousands of variables; NLopt's "LD_…" algorithms only.
/// @throws InvalidInput for an algorithm that takes no slopes.
[[nodiscard]] MinimizeResult minimize_with_slopes(const std::vector<Variable>& variables,
                                                  const SteepObjective& objective, const MinimizeOptions& options,
                                                  const SearchObserver& observer = {});

}  // namespace mezzotint
