#include "inverse/design/parameter_intervals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>
#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

#include "forward/base/error.h"
#include "forward/scattering/bin_interval.h"
#include "inverse/design/design_variables.h"
#include "inverse/target/implied_slopes.h"

namespace mezzotint {

namespace {

constexpr double undetermined_from = 0.25;
constexpr double step = 0.02;  // of the combinations' units; central differences, so errors are of its square

bool is_angle(const Variable& variable) { return variable.name.ends_with("_deg"); }

double moved(const Variable& variable, double value, double change) {
  if (variable.logarithmic) return value * std::exp(change);
  return value + (is_angle(variable) ? change * 180.0 / std::numbers::pi : change);
}

Eigen::Matrix2d matrix_of(const SlopeCovariance& c) {
  Eigen::Matrix2d matrix;
  matrix << c.xx, c.xy, c.xy, c.yy;
  return matrix;
}

template <typename Function>
Eigen::Matrix2d spectral(const Eigen::Matrix2d& matrix, const Function& function) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(matrix);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(1e-14).unaryExpr(function).asDiagonal() *
         solver.eigenvectors().transpose();
}

using Residuals = std::vector<double>;

void add_covariance(const SlopeCovariance& shown, const Target& target, double weight, Residuals& r) {
  if (!target.rotation_matters) {
    const SlopeAxes axes = principal_axes(shown);
    r.push_back(weight * 2.0 * std::log(axes.rms_major / target.slopes.rms_major));
    r.push_back(weight * 2.0 * std::log(std::max(axes.rms_minor, 1e-7) / target.slopes.rms_minor));
    return;
  }
  const Eigen::Matrix2d root =
      spectral(matrix_of(covariance_of(target.slopes)), [](double x) { return 1.0 / std::sqrt(x); });
  const Eigen::Matrix2d log = spectral(root * matrix_of(shown) * root, [](double x) { return std::log(x); });
  r.insert(r.end(), {weight * log(0, 0), weight * log(1, 1), weight * std::numbers::sqrt2 * log(0, 1)});
}

double of_curve(Measure measure, double value, double peak) {
  if (measure == Measure::CubeRoot) return std::cbrt(value + 1e-6 * peak);
  return measure == Measure::Logarithm ? std::log1p(value / (0.01 * peak)) : value;
}

void add_bins(const LobeTarget& lobes, const std::vector<DirectionMap>& maps, Measure measure, double weight,
              Residuals& r) {
  for (std::size_t light = 0; light < maps.size(); ++light) {
    const DirectionMap& wanted = lobes.maps[light];
    const double peak = *std::ranges::max_element(wanted);
    double whole = 0.0;
    for (std::size_t k = 0; k < wanted.size(); ++k)
      whole += lobes.grid.areas()[k] * std::pow(of_curve(measure, wanted[k], peak), 2);
    for (std::size_t k = 0; k < wanted.size(); ++k) {
      const double root = std::sqrt(lobes.grid.areas()[k] / (whole * static_cast<double>(maps.size())));
      r.push_back(weight * root * (of_curve(measure, maps[light][k], peak) - of_curve(measure, wanted[k], peak)));
    }
  }
}

Residuals residuals(const DesignGoal& goal, const MeasureSum& lowered, const SlopeModel::Shown& shown) {
  Residuals r;
  for (const WeightedMeasure& term : lowered) {
    const double weight = std::sqrt(term.weight);
    const bool by_moments = term.measure == Measure::Moments || term.measure == Measure::Wasserstein;
    if (term.measure == Measure::SlopeCovariance || by_moments) {
      add_covariance(goal.covariance(shown), goal.target(), weight, r);
      if (by_moments) {
        const double light = implied_slopes(*goal.lobes(), shown.maps).light,
                     wanted = implied_slopes(*goal.lobes(), goal.lobes()->maps).light;
        r.push_back(weight * std::log(light / wanted));
      }
    } else {
      add_bins(*goal.lobes(), shown.maps, term.measure, weight, r);
    }
  }
  return r;
}

Eigen::VectorXd vector_of(const Residuals& r) {
  return Eigen::Map<const Eigen::VectorXd>(r.data(), static_cast<Eigen::Index>(r.size()));
}

Eigen::MatrixXd jacobian(const DesignGoal& goal, const MeasureSum& lowered, const SlopeModel& model,
                         const Pattern& pattern, const std::vector<Variable>& variables,
                         const std::vector<double>& values) {
  Eigen::MatrixXd j;
  for (std::size_t i = 0; i < variables.size(); ++i) {
    const auto at = [&](double change) {
      std::vector<double> place = values;
      place[i] = moved(variables[i], values[i], change);
      return vector_of(residuals(goal, lowered, model.shown(with_values(pattern, variables, place))));
    };
    const Eigen::VectorXd slope = (at(step) - at(-step)) / (2.0 * step);
    if (j.size() == 0) j.resize(slope.size(), static_cast<Eigen::Index>(variables.size()));
    j.col(static_cast<Eigen::Index>(i)) = slope;
  }
  return j;
}

// Delete-one pseudo-values of the residuals, about their mean: one column a draw.
Eigen::MatrixXd pseudo_values(const DesignGoal& goal, const MeasureSum& lowered,
                              const std::vector<SlopeModel::Shown>& draws) {
  const auto n = static_cast<double>(draws.size());
  Eigen::MatrixXd columns;
  for (std::size_t i = 0; i < draws.size(); ++i) {
    std::vector<SlopeModel::Shown> others = draws;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    const Eigen::VectorXd without = vector_of(residuals(goal, lowered, mean_of(others)));
    if (columns.size() == 0) columns.resize(without.size(), static_cast<Eigen::Index>(draws.size()));
    columns.col(static_cast<Eigen::Index>(i)) = -(n - 1.0) * without;
  }
  const Eigen::VectorXd mean = columns.rowwise().mean();
  return columns.colwise() - mean;
}

}  // namespace

ParameterIntervals parameter_intervals(const DesignGoal& goal, const MeasureSum& lowered, const SlopeModel& model,
                                       const Pattern& pattern, const std::vector<Variable>& variables,
                                       const std::vector<double>& values, double target_draws) {
  require(model.draw_count() >= 3, "intervals come from the scatter of at least three draws");
  const auto n = static_cast<double>(model.draw_count());
  const Eigen::MatrixXd j = jacobian(goal, lowered, model, pattern, variables, values);
  const Eigen::MatrixXd scatter = pseudo_values(goal, lowered, model.draws(with_values(pattern, variables, values)));
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(j, Eigen::ComputeThinU | Eigen::ComputeFullV);
  const double t = student_95(static_cast<std::uint32_t>(model.draw_count() - 1));
  // The mean of n draws, and a target that is itself the mean of some.
  const double per_draw = 1.0 / n + 1.0 / target_draws;

  ParameterIntervals intervals;
  intervals.half_widths_95.assign(variables.size(), 0.0);
  const auto count = static_cast<Eigen::Index>(variables.size());
  Eigen::MatrixXd determined_scores = Eigen::MatrixXd::Zero(count, scatter.cols());
  for (Eigen::Index k = 0; k < count; ++k) {
    ParameterCombination combination;
    combination.change.resize(variables.size());
    const bool has_value = k < svd.singularValues().size() && svd.singularValues()(k) > 0.0;
    const Eigen::VectorXd direction =
        svd.matrixV().col(k);  // all of them: fewer figures than variables leave some free
    for (Eigen::Index i = 0; i < count; ++i) combination.change[static_cast<std::size_t>(i)] = direction(i);
    if (has_value) {
      const Eigen::RowVectorXd scores = svd.matrixU().col(k).transpose() * scatter / svd.singularValues()(k);
      combination.half_width_95 = t * std::sqrt(scores.squaredNorm() / (n - 1.0) * per_draw);
      combination.determined =
          combination.half_width_95 <= undetermined_from && svd.singularValues()(k) >= 0.02 * svd.singularValues()(0);
      if (combination.determined) determined_scores += direction * scores;
    } else {
      combination.half_width_95 = std::numeric_limits<double>::infinity();
    }
    for (std::size_t i = 0; i < variables.size(); ++i) {
      if (!combination.determined && std::abs(combination.change[i]) > 0.1)
        intervals.half_widths_95[i] = std::numeric_limits<double>::infinity();
    }
    intervals.combinations.push_back(std::move(combination));
  }
  for (std::size_t i = 0; i < variables.size(); ++i) {
    const double square = determined_scores.row(static_cast<Eigen::Index>(i)).squaredNorm() / (n - 1.0) * per_draw;
    intervals.half_widths_95[i] = std::max(intervals.half_widths_95[i], t * std::sqrt(square));
  }
  return intervals;
}

std::string in_words(const ParameterCombination& combination, const std::vector<Variable>& variables) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < variables.size(); ++i) {
    if (std::abs(combination.change[i]) >= 0.1) order.push_back(i);
  }
  std::ranges::stable_sort(order, std::ranges::greater{},
                           [&](std::size_t i) { return std::abs(combination.change[i]); });
  // The sign of a direction means nothing: the first one grows.
  const double sign = order.empty() || combination.change[order.front()] >= 0.0 ? 1.0 : -1.0;
  std::string words;
  for (const std::size_t i : order) {
    const double change = sign * combination.change[i];
    const char* form = variables[i].logarithmic ? "{} × e^{:+.2f}" : "{} {:+.2f}";
    words += (words.empty() ? "" : ", ") +
             fmt::format(fmt::runtime(form), variables[i].name,
                         is_angle(variables[i]) ? change * 180.0 / std::numbers::pi : change) +
             (is_angle(variables[i]) ? "°" : "");
  }
  return words;
}

}  // namespace mezzotint
