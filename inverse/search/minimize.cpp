#include "inverse/search/minimize.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>

#include <nlopt.h>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

// What is not finite must be worse than everything, but a number that model-building algorithms can digest.
constexpr double penalty = 1e30;

struct NloptDeleter {
  void operator()(nlopt_opt optimizer) const { nlopt_destroy(optimizer); }
};
using Optimizer = std::unique_ptr<std::remove_pointer_t<nlopt_opt>, NloptDeleter>;

bool wants_gradient(const std::string& name) { return name.size() > 1 && name[1] == 'D'; }
bool wants_local_search(const std::string& name) {
  return name.find("MLSL") != std::string::npos || name.find("AUGLAG") != std::string::npos;
}

double to_unit(const Variable& variable, double value) {
  if (variable.logarithmic) return std::log(value / variable.low) / std::log(variable.high / variable.low);
  return (value - variable.low) / (variable.high - variable.low);
}
// ∂value/∂unit.
double stretch(const Variable& variable, double value) {
  return variable.logarithmic ? value * std::log(variable.high / variable.low) : variable.high - variable.low;
}
double from_unit(const Variable& variable, double unit) {
  const double t = std::clamp(unit, 0.0, 1.0);
  const double value = variable.logarithmic ? variable.low * std::pow(variable.high / variable.low, t)
                                            : variable.low + t * (variable.high - variable.low);
  return std::clamp(value, variable.low, variable.high);
}

void require_valid_variables(const std::vector<Variable>& variables) {
  require(!variables.empty(), "a search needs at least one free parameter");
  for (const auto& variable : variables) {
    const bool ordered = std::isfinite(variable.low) && std::isfinite(variable.high) && variable.low < variable.high;
    require(ordered, variable.name + ": the lower bound must be below the upper one");
    require(!variable.logarithmic || variable.low > 0.0, variable.name + ": its bounds must be positive");
    require(variable.start >= variable.low && variable.start <= variable.high,
            variable.name + ": the start must lie between the bounds");
  }
}

// The border between NLopt and the rest: counts, keeps the best, and lets no exception through to C.
class Border {
public:
  Border(const std::vector<Variable>& variables, Objective objective, SteepObjective steep,
         const SearchObserver& observer, int max_evaluations)
      : variables_(variables),
        objective_(std::move(objective)),
        steep_(std::move(steep)),
        observer_(observer),
        max_evaluations_(max_evaluations) {
    result_.best.objective = std::numeric_limits<double>::infinity();
  }

  void attach(nlopt_opt optimizer) {
    optimizer_ = optimizer;
    nlopt_set_min_objective(optimizer, &Border::call, this);
  }
  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }
  [[nodiscard]] bool ran_out() const { return result_.evaluations >= max_evaluations_; }
  // Asked at more places than a model of first order has numbers, and the same at all of them.
  [[nodiscard]] bool was_flat() const {
    const auto asked = static_cast<std::size_t>(result_.evaluations - result_.not_finite);
    return asked > variables_.size() + 1 && highest_ == result_.best.objective;
  }
  [[nodiscard]] MinimizeResult take() { return std::move(result_); }

private:
  static double call(unsigned count, const double* unit, double* gradient, void* self) {
    auto& border = *static_cast<Border*>(self);
    const std::vector<double> point(unit, unit + count);
    if (border.steep_) {
      std::vector<double> slopes(count, 0.0);
      const double value = border.evaluate(point, &slopes);
      if (gradient != nullptr) std::ranges::copy(slopes, gradient);
      return value;
    }
    const double value = border.evaluate(point, nullptr);
    for (unsigned i = 0; gradient != nullptr && i < count; ++i) gradient[i] = border.slope(point, i);
    return value;
  }

  // Central difference, one-sided at a bound.
  double slope(std::vector<double> point, unsigned i) {
    constexpr double step = 1e-3;
    const double low = std::max(0.0, point[i] - step), high = std::min(1.0, point[i] + step);
    point[i] = high;
    const double above = evaluate(point, nullptr);
    point[i] = low;
    return (above - evaluate(point, nullptr)) / (high - low);
  }

  double evaluate(const std::vector<double>& unit, std::vector<double>* slopes) {
    if (failure_ || ran_out()) {
      nlopt_force_stop(optimizer_);
      return penalty;
    }
    try {
      return evaluate_unguarded(unit, slopes);
    } catch (...) {
      failure_ = std::current_exception();
      nlopt_force_stop(optimizer_);
      return penalty;
    }
  }

  // Slopes are wanted in the unit cube, where NLopt works.
  double evaluate_unguarded(const std::vector<double>& unit, std::vector<double>* slopes) {
    SearchStep step;
    for (std::size_t i = 0; i < unit.size(); ++i) step.values.push_back(from_unit(variables_[i], unit[i]));
    step.objective = slopes != nullptr ? steep_(step.values, *slopes) : objective_(step.values);
    for (std::size_t i = 0; slopes != nullptr && i < unit.size(); ++i)
      (*slopes)[i] *= stretch(variables_[i], step.values[i]);
    if (slopes != nullptr && !all_finite(step.objective, *slopes)) {
      step.objective = std::numeric_limits<double>::quiet_NaN();
      std::ranges::fill(*slopes, 0.0);
    }
    ++result_.evaluations;
    count(step);
    if (observer_) observer_(result_.evaluations, step);
    return std::isfinite(step.objective) ? std::min(step.objective, penalty) : penalty;
  }

  static bool all_finite(double objective, const std::vector<double>& slopes) {
    return std::isfinite(objective) && std::ranges::all_of(slopes, [](double slope) { return std::isfinite(slope); });
  }

  void count(const SearchStep& step) {
    if (!std::isfinite(step.objective)) {
      ++result_.not_finite;
      return;
    }
    highest_ = std::max(highest_, step.objective);
    if (step.objective < result_.best.objective) result_.best = step;
  }

  const std::vector<Variable>& variables_;
  Objective objective_;
  SteepObjective steep_;  // where it is there, the other one is not
  const SearchObserver& observer_;
  int max_evaluations_;
  nlopt_opt optimizer_ = nullptr;
  std::exception_ptr failure_;
  MinimizeResult result_;
  double highest_ = -std::numeric_limits<double>::infinity();  // of the finite objectives
};

Optimizer make_optimizer(const std::string& name, unsigned count, const MinimizeOptions& options) {
  Optimizer optimizer(nlopt_create(nlopt_algorithm_from_string(name.c_str()), count));
  if (!optimizer) throw MethodError("NLopt could not set up " + name);
  nlopt_set_lower_bounds1(optimizer.get(), 0.0);
  nlopt_set_upper_bounds1(optimizer.get(), 1.0);
  // On the unit cube a relative tolerance of the variables is an absolute one; AUGLAG and MLSL crash without it.
  nlopt_set_xtol_abs1(optimizer.get(), options.relative_tolerance);
  nlopt_set_initial_step1(optimizer.get(), options.initial_step);
  nlopt_set_stopval(optimizer.get(), options.good_enough);
  // The border counts by itself; StoGO knows no forced stop, only this.
  nlopt_set_maxeval(optimizer.get(), options.max_evaluations);
  return optimizer;
}

std::string in_words(nlopt_result result, bool ran_out) {
  if (ran_out) return "the budget of evaluations is used up";
  switch (result) {
    case NLOPT_SUCCESS:
    case NLOPT_FTOL_REACHED:
    case NLOPT_XTOL_REACHED:
      return "converged to the tolerance";
    case NLOPT_STOPVAL_REACHED:
      return "the objective is as low as was asked for";
    case NLOPT_ROUNDOFF_LIMITED:
      return "no further progress: limited by rounding";
    default:
      return std::string("ended early: ") + nlopt_result_to_string(result);
  }
}

}  // namespace

// An unknown name is −1, which the unsigned enumeration would hide.
bool is_known_algorithm(const std::string& name) {
  return static_cast<int>(nlopt_algorithm_from_string(name.c_str())) >= 0;
}

namespace {

void require_valid_search(const std::vector<Variable>& variables, const MinimizeOptions& options) {
  require_valid_variables(variables);
  require(options.max_evaluations > 0, "a search needs at least one evaluation");
  require(is_known_algorithm(options.algorithm),
          "NLopt knows no algorithm \"" + options.algorithm +
              "\"; names read like LN_BOBYQA, LN_SBPLX, LN_COBYLA, "
              "LN_NELDERMEAD, GN_DIRECT_L, GN_CRS2_LM, G_MLSL_LDS, LD_LBFGS, LD_SLSQP");
}

// Some algorithms give up before they ask once: for one variable, for many, or without their own library.
void require_result(const MinimizeResult& result, const std::string& algorithm, std::size_t variables,
                    nlopt_opt optimizer) {
  if (result.evaluations == 0) {
    const char* reason = nlopt_get_errmsg(optimizer);
    throw MethodError(algorithm + " ended before its first evaluation" +
                      (reason != nullptr ? " (NLopt: " + std::string(reason) + ")" : "") + "; it does not suit " +
                      std::to_string(variables) + (variables == 1 ? " variable" : " variables") +
                      " between bounds, or is not in this NLopt; LN_BOBYQA and LN_SBPLX suit any number");
  }
  if (!std::isfinite(result.best.objective)) {
    throw MethodError(algorithm + " made " + std::to_string(result.evaluations) +
                      " evaluations and none gave a finite objective; start elsewhere, or narrow the bounds");
  }
}

MinimizeResult run(const std::vector<Variable>& variables, Border& border, const MinimizeOptions& options) {
  const auto count = static_cast<unsigned>(variables.size());
  const Optimizer optimizer = make_optimizer(options.algorithm, count, options);
  if (wants_local_search(options.algorithm)) {
    const std::string local = wants_gradient(options.algorithm) ? "LD_SLSQP" : "LN_BOBYQA";
    nlopt_set_local_optimizer(optimizer.get(), make_optimizer(local, count, options).get());
  }
  nlopt_srand(static_cast<unsigned long>(options.seed));

  border.attach(optimizer.get());
  std::vector<double> unit;
  unit.reserve(variables.size());
  for (const auto& variable : variables) unit.push_back(to_unit(variable, variable.start));
  double last = 0.0;
  const nlopt_result outcome = nlopt_optimize(optimizer.get(), unit.data(), &last);
  border.rethrow();
  const bool ran_out = border.ran_out(), flat = border.was_flat();
  MinimizeResult result = border.take();
  require_result(result, options.algorithm, variables.size(), optimizer.get());
  result.outcome = flat ? "the objective is the same wherever it was asked: nothing that is free shows in it"
                        : in_words(outcome, ran_out);
  result.converged = !ran_out && !flat && outcome > 0;
  return result;
}

}  // namespace

MinimizeResult minimize(const std::vector<Variable>& variables, const Objective& objective,
                        const MinimizeOptions& options, const SearchObserver& observer) {
  require_valid_search(variables, options);
  Border border(variables, objective, {}, observer, options.max_evaluations);
  return run(variables, border, options);
}

MinimizeResult minimize_with_slopes(const std::vector<Variable>& variables, const SteepObjective& objective,
                                    const MinimizeOptions& options, const SearchObserver& observer) {
  require_valid_search(variables, options);
  require(wants_gradient(options.algorithm),
          options.algorithm + " takes no slopes; those that do read like LD_MMA, LD_LBFGS, LD_SLSQP");
  Border border(variables, {}, objective, observer, options.max_evaluations);
  return run(variables, border, options);
}

}  // namespace mezzotint
