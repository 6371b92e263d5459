#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

// In this order.
// clang-format off
#include <rapidcheck.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
// clang-format on

#include "inverse/search/minimize.h"

namespace mezzotint {
namespace {

// The same cases in every run, unless someone asks for others.
[[maybe_unused]] const int seeded = ::setenv("RC_PARAMS", "seed=1", 0);

double number(int low, int high) { return *rc::gen::inRange(low, high) / 1000.0; }

Variable any_variable() {
  Variable variable;
  variable.name = "number";
  variable.logarithmic = *rc::gen::arbitrary<bool>();
  variable.low = variable.logarithmic ? number(1, 5000) : number(-5000, 5000);
  variable.high = variable.low + number(1, 20000);
  variable.start = variable.low + number(0, 1001) * (variable.high - variable.low);
  variable.start = std::min(variable.start, variable.high);
  return variable;
}

// Whatever the box, the start, the algorithm and the budget: the best lies between the bounds, was seen, and is no
// worse than anything that was seen.
RC_GTEST_PROP(MinimizeProperty, BestIsSeenInsideAndNeverBeaten, ()) {
  std::vector<Variable> variables;
  const int count = *rc::gen::inRange(2, 6);
  for (int i = 0; i < count; ++i) variables.push_back(any_variable());
  MinimizeOptions options;
  options.algorithm = *rc::gen::element<std::string>("LN_BOBYQA", "LN_SBPLX", "LN_COBYLA", "LN_NELDERMEAD", "LD_SLSQP",
                                                     "LD_LBFGS", "LD_MMA", "GN_CRS2_LM", "GN_DIRECT_L", "G_MLSL_LDS");
  options.max_evaluations = *rc::gen::inRange(1, 120);
  const double middle = number(-5000, 5000), ripple = number(0, 3000);
  const auto objective = [&](const std::vector<double>& point) {
    double sum = 0.0;
    for (const double x : point) sum += std::pow(x - middle, 2) + ripple * std::sin(5.0 * x);
    return sum;
  };
  double lowest = HUGE_VAL, at_start = HUGE_VAL;
  int calls = 0;
  const auto watched = [&](const std::vector<double>& point) {
    for (std::size_t i = 0; i < point.size(); ++i)
      RC_ASSERT(point[i] >= variables[i].low && point[i] <= variables[i].high);
    const double value = objective(point);
    lowest = std::min(lowest, value);
    if (++calls == 1) at_start = value;
    return value;
  };
  const MinimizeResult found = minimize(variables, watched, options);
  RC_ASSERT(found.evaluations == calls);
  RC_ASSERT(calls <= options.max_evaluations);
  RC_ASSERT(found.best.objective == lowest);
  RC_ASSERT(found.best.objective <= at_start);
  RC_ASSERT(objective(found.best.values) == found.best.objective);
  for (std::size_t i = 0; i < variables.size(); ++i)
    RC_ASSERT(found.best.values[i] >= variables[i].low && found.best.values[i] <= variables[i].high);
}

}  // namespace
}  // namespace mezzotint
