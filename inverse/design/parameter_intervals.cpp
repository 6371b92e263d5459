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
#include "inverse/target/covariance_matrix.h"
#include "inverse/target/implied_slopes.h"

namespace mezzotint {

namespace {

constexpr double undetermined_from = 0.25;
constexpr double least_singular = 0.02;  // of the largest: what is flatter is noise of the bins
constexpr double step = 0.05;            // of the combinations' units; central differences, so errors are of its square
// Bins are put together before they are compared: a pattern's points wander from bin to bin with every parameter, which
// would count as knowledge of it.
constexpr std::size_t coarse = 4;
// Slopes are put right last (search_pattern), so that they decide where shape and slopes disagree.
constexpr double weight_of_slopes = 10.0;

bool is_angle(const Variable& variable) { return variable.name.ends_with("_deg"); }

double moved(const Variable& variable, double value, double change) {
  if (variable.logarithmic) return value * std::exp(change);
  return value + (is_angle(variable) ? change * 180.0 / std::numbers::pi : change);
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

// Means over squares of bins.
DirectionMap coarsened(const SmoothGrid& grid, const DirectionMap& map, DirectionMap& areas) {
  const std::size_t width = grid.grid().width, height = grid.grid().height;
  const std::size_t columns = (width + coarse - 1) / coarse, rows = (height + coarse - 1) / coarse;
  DirectionMap light(columns * rows, 0.0);
  areas.assign(light.size(), 0.0);
  for (std::size_t k = 0; k < map.size(); ++k) {
    const std::size_t into = k / width / coarse * columns + k % width / coarse;
    light[into] += map[k] * grid.areas()[k];
    areas[into] += grid.areas()[k];
  }
  for (std::size_t k = 0; k < light.size(); ++k) light[k] = areas[k] > 0.0 ? light[k] / areas[k] : 0.0;
  return light;
}

void add_bins(const LobeTarget& lobes, const std::vector<DirectionMap>& maps, Measure measure, double weight,
              Residuals& r) {
  for (std::size_t light = 0; light < maps.size(); ++light) {
    DirectionMap areas;
    const DirectionMap shown = coarsened(lobes.grid, maps[light], areas),
                       wanted = coarsened(lobes.grid, lobes.maps[light], areas);
    const double peak = *std::ranges::max_element(wanted);
    double whole = 0.0;
    for (std::size_t k = 0; k < wanted.size(); ++k) whole += areas[k] * std::pow(of_curve(measure, wanted[k], peak), 2);
    for (std::size_t k = 0; k < wanted.size(); ++k) {
      const double root = std::sqrt(areas[k] / (whole * static_cast<double>(maps.size())));
      r.push_back(weight * root * (of_curve(measure, shown[k], peak) - of_curve(measure, wanted[k], peak)));
    }
  }
}

Residuals residuals(const DesignGoal& goal, const MeasureSum& lowered, const SlopeModel::Shown& shown) {
  Residuals r;
  for (const WeightedMeasure& term : lowered) {
    const double weight = std::sqrt(term.weight);
    const bool by_moments = term.measure == Measure::Moments || term.measure == Measure::Wasserstein;
    if (term.measure == Measure::SlopeCovariance || by_moments) {
      add_covariance(goal.covariance(shown), goal.target(), weight_of_slopes * weight, r);
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

double square(double value) { return value * value; }

// How uncertain a linear figure of the residuals is.
class Scatter {
public:
  Scatter(const DesignGoal& goal, const MeasureSum& lowered, const std::vector<SlopeModel::Shown>& searched,
          const std::vector<SlopeModel::Shown>& fresh, double target_draws)
      : searched_(pseudo_values(goal, lowered, searched)),
        fresh_(pseudo_values(goal, lowered, fresh)),
        moved_(vector_of(residuals(goal, lowered, mean_of(fresh))) -
               vector_of(residuals(goal, lowered, mean_of(searched)))),
        target_draws_(target_draws) {}

  [[nodiscard]] double half_width_95(const Eigen::VectorXd& figure) const {
    const auto variance = [&](const Eigen::MatrixXd& pseudo) {
      return (figure.transpose() * pseudo).squaredNorm() / static_cast<double>(pseudo.cols() - 1);
    };
    const double n = static_cast<double>(searched_.cols()), n_fresh = static_cast<double>(fresh_.cols());
    const double of_search = variance(searched_) / n, of_fresh = variance(fresh_);
    const double t = student_95(static_cast<std::uint32_t>(std::min(n, n_fresh) - 1.0));
    const double unexplained = std::max(0.0, square(figure.dot(moved_)) - of_search - of_fresh / n_fresh);
    return std::sqrt(square(t) * (of_search + of_fresh / target_draws_) + square(2.0) * unexplained);
  }

private:
  Eigen::MatrixXd searched_, fresh_;
  Eigen::VectorXd moved_;
  double target_draws_;
};

}  // namespace

ParameterIntervals parameter_intervals(const DesignGoal& goal, const MeasureSum& lowered, const SlopeModel& model,
                                       const Pattern& pattern, const std::vector<Variable>& variables,
                                       const std::vector<double>& values, const std::vector<SlopeModel::Shown>& fresh,
                                       double target_draws) {
  require(model.draw_count() >= 3 && fresh.size() >= 3, "intervals come from the scatter of at least three draws");
  const Eigen::MatrixXd j = jacobian(goal, lowered, model, pattern, variables, values);
  const Scatter scatter(goal, lowered, model.draws(with_values(pattern, variables, values)), fresh, target_draws);
  // All directions: fewer figures than variables leave some free.
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(j, Eigen::ComputeThinU | Eigen::ComputeFullV);
  const auto count = static_cast<Eigen::Index>(variables.size());
  const Eigen::VectorXd& singular = svd.singularValues();

  ParameterIntervals intervals;
  Eigen::MatrixXd to_parameters = Eigen::MatrixXd::Zero(count, j.rows());  // of what is determined
  for (Eigen::Index k = 0; k < count; ++k) {
    ParameterCombination combination{.change = std::vector<double>(variables.size(), 0.0),
                                     .half_width_95 = std::numeric_limits<double>::infinity()};
    for (Eigen::Index i = 0; i < count; ++i) combination.change[static_cast<std::size_t>(i)] = svd.matrixV()(i, k);
    if (k < singular.size() && singular(k) > 0.0) {
      const Eigen::VectorXd direction = svd.matrixU().col(k) / singular(k);
      combination.half_width_95 = scatter.half_width_95(direction);
      combination.determined =
          combination.half_width_95 <= undetermined_from && singular(k) >= least_singular * singular(0);
      if (combination.determined) to_parameters += svd.matrixV().col(k) * direction.transpose();
    }
    intervals.combinations.push_back(std::move(combination));
  }
  for (Eigen::Index i = 0; i < count; ++i) {
    const bool is_moved = std::ranges::any_of(intervals.combinations, [i](const ParameterCombination& c) {
      return !c.determined && std::abs(c.change[static_cast<std::size_t>(i)]) > 0.1;
    });
    intervals.half_widths_95.push_back(is_moved ? std::numeric_limits<double>::infinity()
                                                : scatter.half_width_95(to_parameters.row(i).transpose()));
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
