#include "inverse/target/target.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "forward/base/error.h"
#include "inverse/target/covariance_matrix.h"

namespace mezzotint {

namespace {

constexpr double least_alpha = 1e-3, largest_alpha = 2.0;
// A variance of slopes below this is a mirror; keeps logarithms finite.
constexpr double least_variance = 1e-12;

void require_alpha(double alpha, const char* name) {
  require(alpha >= least_alpha && alpha <= largest_alpha,
          std::string("the target's ") + name + " must be in [0.001, 2]; a Beckmann α is √2 times the RMS slope");
}

Target target_of(std::string kind, double alpha_x, double alpha_y, Angle rotation, bool rotation_matters) {
  const double to_slope = std::sqrt(0.5);
  return {.kind = std::move(kind),
          .slopes = {alpha_x * to_slope, alpha_y * to_slope, rotation},
          .rotation_matters = rotation_matters};
}

double square(double value) { return value * value; }

double log_variance_distance(double rms, double wanted_rms) {
  return std::log(std::max(square(rms), least_variance) / square(wanted_rms));
}

}  // namespace

Target beckmann_target(const BeckmannLobe& lobe) {
  require_alpha(lobe.alpha_x, "alpha_x");
  require_alpha(lobe.alpha_y, "alpha_y");
  require(lobe.alpha_x >= lobe.alpha_y,
          "the target's alpha_x is that of the steeper axis and must not be below alpha_y; turn rotation_deg by 90");
  const bool round = lobe.alpha_x / lobe.alpha_y < 1.02;
  return target_of("beckmann", lobe.alpha_x, lobe.alpha_y, lobe.rotation, !round);
}

Target anisotropy_target(double ratio, double mean_alpha) {
  require(ratio >= 1.0 && ratio <= 100.0, "the target's ratio α_x/α_y must be in [1, 100]");
  const double alpha_x = mean_alpha * std::sqrt(ratio), alpha_y = mean_alpha / std::sqrt(ratio);
  require_alpha(alpha_x, "mean_alpha·√ratio");
  require_alpha(alpha_y, "mean_alpha/√ratio");
  return target_of("anisotropy", alpha_x, alpha_y, Angle{}, false);
}

Target scan_target(const HeightField& relief) {
  require(relief.missing_count() == 0, "a scan with missing samples cannot be a target; fill them first");
  const SlopeAxes slopes = principal_axes(slope_covariance(relief));
  require(slopes.rms_major >= least_alpha, "the scan is flat: its RMS slope is below 0.001, nothing to match");
  return {.kind = "scan", .slopes = slopes, .rotation_matters = slopes.rms_major > 1.1 * slopes.rms_minor};
}

BeckmannLobe lobe_of(const SlopeAxes& slopes) {
  const double to_alpha = std::sqrt(2.0), least = 1e-4;
  return {std::max(least, to_alpha * slopes.rms_major), std::max(least, to_alpha * slopes.rms_minor), slopes.rotation};
}

double TargetError::largest() const { return std::max(std::abs(variance_major), std::abs(variance_minor)); }

TargetError target_error(const SlopeCovariance& achieved, const Target& target) {
  const SlopeAxes axes = principal_axes(achieved);
  return {square(axes.rms_major / target.slopes.rms_major) - 1.0,
          square(axes.rms_minor / target.slopes.rms_minor) - 1.0,
          target.rotation_matters ? axis_difference(axes.rotation, target.slopes.rotation) : Angle{}};
}

bool is_met(const TargetError& error, const Target& target) {
  return error.largest() <= target.tolerance && error.rotation <= target.rotation_tolerance;
}

double covariance_distance(const SlopeCovariance& achieved, const Target& target) {
  if (!target.rotation_matters) {
    const SlopeAxes axes = principal_axes(achieved);
    return square(log_variance_distance(axes.rms_major, target.slopes.rms_major)) +
           square(log_variance_distance(axes.rms_minor, target.slopes.rms_minor));
  }
  const Eigen::Matrix2d floor = least_variance * Eigen::Matrix2d::Identity();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix2d> solver(
      matrix_of(achieved) + floor, matrix_of(covariance_of(target.slopes)), Eigen::EigenvaluesOnly);
  return solver.eigenvalues().array().max(least_variance).log().square().sum();
}

// An eigenvalue λ of C v = λ T v with vᵀ T v = 1 changes by vᵀ dC v. T is the target's covariance, or, where only the
// two variances count, the unit matrix, with the wanted variances beside.
CovarianceDistance covariance_distance_with_slopes(const SlopeCovariance& achieved, const Target& target) {
  const SlopeAxes& wanted = target.slopes;
  const double floor = target.rotation_matters ? least_variance : 0.0;
  const Eigen::Matrix2d unit = Eigen::Matrix2d::Identity();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix2d> solver(
      matrix_of(achieved) + floor * unit, target.rotation_matters ? matrix_of(covariance_of(wanted)) : unit);
  const std::array<double, 2> variances =
      target.rotation_matters ? std::array{1.0, 1.0} : std::array{square(wanted.rms_minor), square(wanted.rms_major)};
  CovarianceDistance result;
  Eigen::Matrix2d toward = Eigen::Matrix2d::Zero();
  for (int i = 0; i < 2; ++i) {
    const double value = solver.eigenvalues()[i],
                 off = std::log(std::max(value, least_variance) / variances[std::size_t(i)]);
    result.value += square(off);
    if (value > least_variance)
      toward += 2.0 * off / value * solver.eigenvectors().col(i) * solver.eigenvectors().col(i).transpose();
  }
  result.slopes = {toward(0, 0), toward(1, 1), 2.0 * toward(0, 1)};
  return result;
}

}  // namespace mezzotint
