#include "fabrication/calibration/cure_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <Eigen/Dense>

#include "fabrication/calibration/cure_likelihood.h"
#include "fabrication/calibration/profile_interval.h"
#include "fabrication/calibration/quantiles.h"
#include "forward/base/error.h"

namespace mezzotint {

namespace {

constexpr double detectable = 2.0;  // standard errors
constexpr double level_95 = 0.975;

void require_valid(const CurePoint& point) {
  const std::string where = point.place.empty() ? "a step" : point.place;
  require(std::isfinite(point.height_um) && std::isfinite(point.gray) && std::isfinite(point.exposure),
          where + ": gray value, exposure and height must be finite numbers");
  require(point.gray >= 0.0 && point.gray <= 1.0, where + ": a gray value is between 0 and 1 (or level 0 and 255)");
  require(point.exposure > 0.0, where + ": an exposure must be positive");
  require(point.repeats > 0.0, where + ": the number of repeats must be positive");
  require(!point.standard_error_um || (std::isfinite(*point.standard_error_um) && *point.standard_error_um > 0.0),
          where + ": a standard error must be positive");
}

// Whether all bring their error, or none does.
bool errors_are_given(const std::vector<CurePoint>& points) {
  const auto given = std::count_if(points.begin(), points.end(), [](const auto& p) { return p.standard_error_um; });
  require(given == 0 || given == static_cast<std::ptrdiff_t>(points.size()),
          "either every step has a standard error or none has");
  return given > 0;
}

std::vector<WeighedPoint> weigh(const std::vector<CurePoint>& points, double scale, double layer_um) {
  std::vector<WeighedPoint> weighed;
  for (const CurePoint& point : points) {
    const double error = scale * point.standard_error_um.value_or(1.0 / std::sqrt(point.repeats));
    PointRole role = PointRole::Measured;
    if (point.height_um < detectable * error)
      role = PointRole::BelowCure;
    else if (point.height_um > layer_um - detectable * error)
      role = PointRole::Saturated;
    weighed.push_back({point.gray, point.exposure, point.height_um, error, role});
  }
  return weighed;
}

std::size_t measured_doses(const std::vector<WeighedPoint>& points) {
  std::set<std::pair<double, double>> doses;
  for (const WeighedPoint& point : points) {
    if (point.role == PointRole::Measured) doses.insert({point.gray, point.exposure});
  }
  return doses.size();
}

std::vector<double> measured_residuals(const std::vector<WeighedPoint>& points, const CureParameters& parameters,
                                       double layer_um) {
  std::vector<double> residuals;
  for (const WeighedPoint& point : points) {
    if (point.role != PointRole::Measured) continue;
    const double curve_um = curve_value(parameters, point.gray, point.exposure, layer_um).height_um;
    residuals.push_back((point.height_um - curve_um) / point.error_um);
  }
  return residuals;
}

// Huber's proposal 2: the scale at which residuals, bounded to 1.5 of it, have the square that normal ones would have.
constexpr double scale_bound = 1.5, mean_bounded_square = 0.77847;
double robust_scale(const std::vector<double>& residuals, double degrees_of_freedom) {
  double low = 1e-9, high = 1e-9;
  for (const double r : residuals) high = std::max(high, 2.0 * std::abs(r));
  const double wanted = degrees_of_freedom * mean_bounded_square;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    double sum = 0.0;
    for (const double r : residuals) {
      const double bounded = std::min(std::abs(r) / middle, scale_bound);
      sum += bounded * bounded;
    }
    (sum > wanted ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

// What is fitted, at one scale of the errors.
struct Attempt {
  std::vector<WeighedPoint> points;
  LeastLoss best;
  double scale = 1.0;
  int degrees_of_freedom = 0;
};

class Fitter {
public:
  Fitter(const std::vector<CurePoint>& points, const CureFitOptions& options)
      : points_(points), options_(options), layer_um_(options.layer.um()), errors_given_(errors_are_given(points)) {}

  [[nodiscard]] CureFit fit() {
    std::optional<double> fixed_gamma;
    Attempt attempt = at_its_scale(fixed_gamma);
    ProfileInterval gamma = interval(attempt, 2, {true, true, true});
    if (!std::isfinite(gamma.low)) {
      fixed_gamma = std::clamp(options_.base.gamma, least_gamma, std::min(gamma.high, largest_gamma));
      attempt = at_its_scale(fixed_gamma);
      say_undetermined(gamma, *fixed_gamma);
    }
    return described(attempt, gamma, !fixed_gamma);
  }

private:
  [[nodiscard]] LeastLoss search(const std::vector<WeighedPoint>& points, const std::optional<double>& gamma) const {
    return gamma ? least_loss_at(points, *gamma, layer_um_) : least_loss(points, layer_um_);
  }

  [[nodiscard]] Attempt at_scale(double scale, const std::optional<double>& gamma) const {
    Attempt attempt{weigh(points_, scale, layer_um_), {}, scale, 0};
    const std::size_t doses = measured_doses(attempt.points);
    require(doses >= 2, fmt::format("the curve needs at least two different doses that cured without filling the layer "
                                    "of {:g} um; of {} steps {} did",
                                    layer_um_, points_.size(), doses));
    attempt.best = search(attempt.points, gamma);
    const auto measured = measured_residuals(attempt.points, attempt.best.parameters, layer_um_).size();
    attempt.degrees_of_freedom = static_cast<int>(measured) - (gamma ? 2 : 3);
    return attempt;
  }

  // With errors that are trusted unless the scatter contradicts them; else with those that the scatter shows.
  [[nodiscard]] Attempt at_its_scale(const std::optional<double>& gamma) {
    Attempt attempt = at_scale(errors_given_ ? 1.0 : first_scale(), gamma);
    scale_is_fitted_ = !errors_given_;
    if (errors_given_) {
      const std::vector<double> residuals = measured_residuals(attempt.points, attempt.best.parameters, layer_um_);
      chi_squared_ = 0.0;
      for (const double r : residuals) chi_squared_ += r * r;
      probability_ = chi_squared_chance(chi_squared_, attempt.degrees_of_freedom);
      degrees_of_freedom_ = attempt.degrees_of_freedom;
      if (probability_ >= 0.01 || robust_scale(residuals, attempt.degrees_of_freedom) <= 1.0) return attempt;
      scale_is_fitted_ = true;
    }
    return with_fitted_scale(std::move(attempt), gamma);
  }

  [[nodiscard]] Attempt with_fitted_scale(Attempt attempt, const std::optional<double>& gamma) const {
    for (int i = 0; i < 12; ++i) {
      const int parameters = gamma || attempt.degrees_of_freedom < 1 ? 2 : 3;
      const std::vector<double> residuals = measured_residuals(attempt.points, attempt.best.parameters, layer_um_);
      const int freedom = static_cast<int>(residuals.size()) - parameters;
      require(freedom >= 1, fmt::format("{} steps that cured without filling the layer cannot tell how far heights "
                                        "scatter: give standard errors (standard_error_um), or measure more steps",
                                        residuals.size()));
      const double least = errors_given_ ? 1.0 : least_scale_um;
      const double scale = std::max(least, attempt.scale * robust_scale(residuals, freedom));
      const bool settled = std::abs(scale / attempt.scale - 1.0) < 1e-3;
      attempt = at_scale(scale, gamma);
      if (settled) break;
    }
    return attempt;
  }

  // Before anything is known: a hundredth of the highest step.
  [[nodiscard]] double first_scale() const {
    double highest = 0.0;
    for (const CurePoint& point : points_) highest = std::max(highest, point.height_um);
    return std::max(least_scale_um, 0.01 * highest);
  }

  [[nodiscard]] double quantile(const Attempt& attempt) const {
    return scale_is_fitted_ ? student_quantile(level_95, std::max(1, attempt.degrees_of_freedom))
                            : normal_quantile(level_95);
  }

  // A profile that comes out below the fit has found a better one, from which it starts again.
  [[nodiscard]] ProfileInterval interval(Attempt& attempt, int parameter, const FreeParameters& free) const {
    const double rise = 0.5 * quantile(attempt) * quantile(attempt) * mean_loss_square / mean_loss_slope;
    for (int i = 0;; ++i) {
      ProfileInterval found = profile_interval(attempt.points, attempt.best, parameter, free, rise, layer_um_);
      if (i == 3 || !(found.lowest.loss < attempt.best.loss - 1e-6)) return found;
      attempt.best = found.lowest;
    }
  }

  void say_undetermined(const ProfileInterval& gamma, double fixed) {
    const std::string low = std::isfinite(gamma.low) ? fmt::format("[{:.3g}", gamma.low) : "(-inf";
    const std::string high = std::isfinite(gamma.high) ? fmt::format("{:.3g}]", gamma.high) : "inf)";
    notes_.push_back(
        fmt::format("gamma is not determined: interval {}, {}; it stands at {:.4g}, {}, and alpha and "
                    "beta hold for that. Steps near the first gray that cures would determine it",
                    low, high, fixed,
                    fixed == options_.base.gamma ? "the base profile's"
                                                 : "the end nearest to the base "
                                                   "profile's"));
  }

  [[nodiscard]] CureFit described(Attempt& attempt, const ProfileInterval& gamma, bool gamma_is_free) {
    const FreeParameters free{true, true, gamma_is_free};
    const ProfileInterval alpha = interval(attempt, 0, free), beta = interval(attempt, 1, free);
    CureFit fit;
    const CureParameters& at = attempt.best.parameters;
    fit.curve = {Length::from_um(at[0]), Length::from_um(std::exp(at[1])), at[2]};
    fit.gamma_is_determined = gamma_is_free;
    fit.quantile = quantile(attempt);
    fit.scale = attempt.scale;
    fit.errors_were_given = errors_given_;
    fit.chi_squared = errors_given_ ? chi_squared_ : 0.0;
    fit.probability = errors_given_ ? probability_ : 1.0;
    fit.degrees_of_freedom = errors_given_ ? degrees_of_freedom_ : attempt.degrees_of_freedom;
    set_covariance(fit, attempt, gamma_is_free);
    const auto error = [&](int k) { return std::sqrt(fit.covariance[k][k]); };
    fit.alpha_um = {at[0], error(0), alpha.low, alpha.high};
    fit.beta_um = {std::exp(at[1]), error(1), std::exp(beta.low), std::exp(beta.high)};
    fit.gamma = {at[2], error(2), gamma.low, gamma.high};
    if (gamma_is_free) {
      const ProfileInterval again = interval(attempt, 2, free);
      fit.gamma.low_95 = again.low;
      fit.gamma.high_95 = again.high;
    }
    share_error(fit);
    describe_points(fit, attempt);
    fit.notes.insert(fit.notes.begin(), notes_.begin(), notes_.end());
    return fit;
  }

  void set_covariance(CureFit& fit, const Attempt& attempt, bool gamma_is_free) const {
    const auto sum = information(attempt.points, attempt.best.parameters, layer_um_);
    const int n = gamma_is_free ? 3 : 2;
    Eigen::MatrixXd matrix(n, n);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) matrix(i, j) = sum[i][j];
    }
    const Eigen::MatrixXd inverse = matrix.ldlt().solve(Eigen::MatrixXd::Identity(n, n));
    const double beta = std::exp(attempt.best.parameters[1]);
    // The loss's own spread, E ψ²/(E ψ')², where the weights have the mean E ψ/r already.
    const double factor = mean_loss_weight * mean_loss_square / (mean_loss_slope * mean_loss_slope);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j)
        fit.covariance[i][j] = factor * inverse(i, j) * (i == 1 ? beta : 1.0) * (j == 1 ? beta : 1.0);
    }
  }

  // What all heights share moves α alone.
  void share_error(CureFit& fit) const {
    const double common = options_.common_error_um;
    if (!(common > 0.0)) return;
    const auto widen = [&](double half) { return std::hypot(half, fit.quantile * common); };
    fit.covariance[0][0] += common * common;
    fit.alpha_um.standard_error = std::hypot(fit.alpha_um.standard_error, common);
    fit.alpha_um.low_95 = fit.alpha_um.value - widen(fit.alpha_um.value - fit.alpha_um.low_95);
    fit.alpha_um.high_95 = fit.alpha_um.value + widen(fit.alpha_um.high_95 - fit.alpha_um.value);
  }

  void describe_points(CureFit& fit, const Attempt& attempt) const {
    std::size_t below = 0, saturated = 0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const WeighedPoint& seen = attempt.points[i];
      const double curve_um = curve_value(attempt.best.parameters, seen.gray, seen.exposure, layer_um_).height_um;
      const double residual_um = seen.height_um - curve_um;
      const double root = std::abs(point_loss(seen, attempt.best.parameters, layer_um_).root);
      const bool is_measured = seen.role == PointRole::Measured;
      // A censored one by the residual that would cost as much.
      const double size = is_measured ? std::abs(residual_um) / seen.error_um
                                      : std::sqrt(student_freedom * std::expm1(root * root / (student_freedom + 1.0)));
      const double weight = residual_weight(size);
      fit.points.push_back({points_[i], seen.role, seen.error_um, curve_um, residual_um, weight});
      below += seen.role == PointRole::BelowCure ? 1 : 0;
      saturated += seen.role == PointRole::Saturated ? 1 : 0;
      if (weight < suspicious_weight)
        fit.notes.push_back(fmt::format("{} lies {:+.3g} um off the curve, {:.1f} standard errors: it counts {:.0f} %",
                                        points_[i].place.empty() ? "a step" : points_[i].place, residual_um, size,
                                        100.0 * weight));
    }
    if (below == 0)
      fit.notes.push_back("no step stayed below curing: nothing but the curve itself says where curing begins");
    if (scale_is_fitted_ && errors_given_)
      fit.notes.push_back(
          fmt::format("heights scatter {:.2g} times as far about the curve as their standard errors say "
                      "(chi squared {:.4g} of {} degrees of freedom, a chance of {:.1g}): errors were "
                      "scaled by that",
                      attempt.scale, chi_squared_, degrees_of_freedom_, probability_));
    if (saturated > 0) fit.notes.push_back(fmt::format("{} steps filled the layer of {:g} um", saturated, layer_um_));
  }

  static constexpr double least_scale_um = 1e-3;

  const std::vector<CurePoint>& points_;
  const CureFitOptions& options_;
  double layer_um_;
  bool errors_given_;
  bool scale_is_fitted_ = false;
  double chi_squared_ = 0.0, probability_ = 1.0;
  int degrees_of_freedom_ = 0;
  std::vector<std::string> notes_;
};

}  // namespace

std::string_view role_name(PointRole role) {
  if (role == PointRole::Measured) return "measured";
  return role == PointRole::BelowCure ? "below cure" : "saturated";
}

CureFit fit_cure(const std::vector<CurePoint>& points, const CureFitOptions& options) {
  require(!points.empty(), "the curve needs measured steps");
  require(std::isfinite(options.layer.um()) && options.layer > Length{}, "the layer's thickness must be positive");
  require(std::isfinite(options.common_error_um) && options.common_error_um >= 0.0, "an error must be 0 or more");
  for (const CurePoint& point : points) require_valid(point);
  CureFit fit = Fitter(points, options).fit();
  require_valid(fit.curve);
  return fit;
}

double height_error_um(const CureFit& fit, double gray, double exposure) {
  const double light = gray - fit.curve.gamma;
  if (!(light > 0.0)) return 0.0;
  const std::array<double, 3> slopes{1.0, std::log(exposure * light), -fit.curve.beta.um() / light};
  double sum = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) sum += slopes[i] * fit.covariance[i][j] * slopes[j];
  }
  return std::sqrt(std::max(0.0, sum));
}

}  // namespace mezzotint
