#include "fabrication/calibration/cure_likelihood.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>
#include <unsupported/Eigen/NonLinearOptimization>

#include "fabrication/calibration/quantiles.h"

namespace mezzotint {

namespace {

// Student's loss of a residual r as the square of another one, and its slope toward r.
struct Root {
  double value, slope;
};
Root student_root(double r) {
  constexpr double nu = student_freedom;
  const double value = std::copysign(std::sqrt((nu + 1.0) * std::log1p(r * r / nu)), r);
  const double steepest = std::sqrt((nu + 1.0) / nu);  // at r = 0
  return {value, std::abs(value) > 1e-9 ? (nu + 1.0) * r / ((nu + r * r) * value) : steepest};
}

// √(−2 ln Φ(z)) and its slope toward z.
Root censored_root(double z) {
  const LogNormal normal = log_normal_probability(z);
  const double value = std::sqrt(std::max(0.0, -2.0 * normal.log_probability));
  return {value, value > 1e-12 ? -normal.slope / value : 0.0};
}

// A free subset of the parameters, for Eigen's Levenberg–Marquardt.
struct Problem {
  using Scalar = double;
  using InputType = Eigen::VectorXd;
  using ValueType = Eigen::VectorXd;
  using JacobianType = Eigen::MatrixXd;
  enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };

  const std::vector<WeighedPoint>& points;
  CureParameters fixed;
  std::vector<int> free;
  double layer_um;

  [[nodiscard]] int inputs() const { return static_cast<int>(free.size()); }
  // Not fewer than there are unknowns.
  [[nodiscard]] int values() const { return std::max<int>(static_cast<int>(points.size()), inputs()); }

  [[nodiscard]] CureParameters at(const Eigen::VectorXd& x) const {
    CureParameters parameters = fixed;
    for (int k = 0; k < inputs(); ++k) parameters[free[k]] = x[k];
    parameters[1] = std::clamp(parameters[1], -7.0, 7.0);
    parameters[2] = std::clamp(parameters[2], least_gamma, largest_gamma);
    return parameters;
  }
  int operator()(const Eigen::VectorXd& x, Eigen::VectorXd& roots) const {
    const CureParameters parameters = at(x);
    roots.setZero();
    for (std::size_t i = 0; i < points.size(); ++i)
      roots[static_cast<int>(i)] = point_loss(points[i], parameters, layer_um).root;
    return 0;
  }
  int df(const Eigen::VectorXd& x, Eigen::MatrixXd& slopes) const {
    const CureParameters parameters = at(x);
    slopes.setZero();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const PointLoss loss = point_loss(points[i], parameters, layer_um);
      for (int k = 0; k < inputs(); ++k) slopes(static_cast<int>(i), k) = loss.slopes[free[k]];
    }
    return 0;
  }
};

// The straight line of heights over ln(k (I − γ)), by the measured points' weights.
CureParameters straight_line(const std::vector<WeighedPoint>& points, double gamma) {
  double weight = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (const WeighedPoint& point : points) {
    if (point.role != PointRole::Measured || point.gray - gamma < 1e-9) continue;
    const double w = 1.0 / (point.error_um * point.error_um), dose = std::log(point.exposure * (point.gray - gamma));
    weight += w;
    x += w * dose;
    y += w * point.height_um;
    xx += w * dose * dose;
    xy += w * dose * point.height_um;
  }
  const double spread = weight * xx - x * x;
  const double slope = spread > 1e-12 * weight * xx ? (weight * xy - x * y) / spread : 1.0;
  const double beta = std::clamp(slope, 1e-2, 1e3);
  return {weight > 0.0 ? (y - beta * x) / weight : 0.0, std::log(beta), gamma};
}

}  // namespace

CurveValue curve_value(const CureParameters& parameters, double gray, double exposure, double layer_um) {
  const double light = gray - parameters[2];
  if (!(light > 0.0)) return {0.0, {}};
  const double beta = std::exp(parameters[1]), dose = std::log(exposure * light);
  const double height = parameters[0] + beta * dose;
  if (!(height > 0.0)) return {0.0, {}};
  if (height >= layer_um) return {layer_um, {}};
  return {height, {1.0, beta * dose, -beta / light}};
}

PointLoss point_loss(const WeighedPoint& point, const CureParameters& parameters, double layer_um) {
  constexpr double detectable = 2.0;  // standard errors
  const CurveValue curve = curve_value(parameters, point.gray, point.exposure, layer_um);
  const double toward_height = 1.0 / point.error_um;
  Root root{};
  double toward_curve = 0.0;
  if (point.role == PointRole::Measured) {
    root = student_root((curve.height_um - point.height_um) / point.error_um);
    toward_curve = root.slope * toward_height;
  } else {
    const bool below = point.role == PointRole::BelowCure;
    const double room = below ? -curve.height_um : curve.height_um - layer_um;
    const Root censored = censored_root(room / point.error_um + detectable);
    root = student_root(censored.value);
    toward_curve = root.slope * censored.slope * (below ? -toward_height : toward_height);
  }
  PointLoss loss{root.value, {}};
  for (std::size_t k = 0; k < 3; ++k) loss.slopes[k] = toward_curve * curve.slopes[k];
  return loss;
}

double total_loss(const std::vector<WeighedPoint>& points, const CureParameters& parameters, double layer_um) {
  double sum = 0.0;
  for (const WeighedPoint& point : points) {
    const double root = point_loss(point, parameters, layer_um).root;
    sum += 0.5 * root * root;
  }
  return sum;
}

CureParameters minimize_loss(const std::vector<WeighedPoint>& points, const CureParameters& start,
                             const FreeParameters& free, double layer_um) {
  Problem problem{points, start, {}, layer_um};
  for (int k = 0; k < 3; ++k) {
    if (free[k]) problem.free.push_back(k);
  }
  Eigen::VectorXd x(problem.inputs());
  for (int k = 0; k < problem.inputs(); ++k) x[k] = start[problem.free[k]];
  Eigen::LevenbergMarquardt<Problem> search(problem);
  search.parameters.xtol = search.parameters.ftol = 1e-10;
  search.parameters.maxfev = 200;
  search.minimize(x);
  const CureParameters found = problem.at(x);
  // At a kink a step may have made it worse.
  return total_loss(points, found, layer_um) <= total_loss(points, start, layer_um) ? found : start;
}

LeastLoss least_loss_at(const std::vector<WeighedPoint>& points, double gamma, double layer_um) {
  const CureParameters found = minimize_loss(points, straight_line(points, gamma), {true, true, false}, layer_um);
  return {found, total_loss(points, found, layer_um)};
}

LeastLoss least_loss(const std::vector<WeighedPoint>& points, double layer_um) {
  double dark = 1.0;
  for (const WeighedPoint& point : points) {
    if (point.role == PointRole::Measured) dark = std::min(dark, point.gray);
  }
  LeastLoss best{{}, std::numeric_limits<double>::infinity()};
  const auto offer = [&](const LeastLoss& candidate) {
    if (candidate.loss < best.loss) best = candidate;
  };
  // Below the darkest step that cured, closer together the closer to it; and some above, in case that one is no step.
  constexpr int starts = 24;
  for (int i = 0; i < starts; ++i) {
    const double below = 1e-3 * std::pow((dark - least_gamma) / 1e-3, i / (starts - 1.0));
    offer(least_loss_at(points, std::max(least_gamma, dark - below), layer_um));
  }
  for (int i = 1; i <= 6; ++i) offer(least_loss_at(points, std::min(largest_gamma, dark + 0.06 * i), layer_um));
  const CureParameters found = minimize_loss(points, best.parameters, {true, true, true}, layer_um);
  offer({found, total_loss(points, found, layer_um)});
  return best;
}

std::array<std::array<double, 3>, 3> information(const std::vector<WeighedPoint>& points,
                                                 const CureParameters& parameters, double layer_um) {
  std::array<std::array<double, 3>, 3> sum{};
  for (const WeighedPoint& point : points) {
    const CurveValue curve = curve_value(parameters, point.gray, point.exposure, layer_um);
    double weight = 1.0;
    if (point.role == PointRole::Measured) {
      const double r = (curve.height_um - point.height_um) / point.error_um;
      weight = residual_weight(r) * (student_freedom + 1.0) / student_freedom;
    } else {
      const bool below = point.role == PointRole::BelowCure;
      const double z = (below ? -curve.height_um : curve.height_um - layer_um) / point.error_um + 2.0;
      const double slope = log_normal_probability(z).slope;
      weight = mean_loss_weight * std::clamp(slope * (slope + z), 0.0, 1.0);
    }
    weight /= point.error_um * point.error_um;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) sum[i][j] += weight * curve.slopes[i] * curve.slopes[j];
    }
  }
  return sum;
}

}  // namespace mezzotint
