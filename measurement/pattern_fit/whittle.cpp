#include "measurement/pattern_fit/whittle.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

namespace mezzotint {

namespace {

constexpr int most_rounds = 25;
constexpr double enough = 1e-4;  // gain of the log-likelihood below which a round was the last

NoiseNumbers bounded(NoiseNumbers numbers, const Grid& grid) {
  const ScaleBounds bounds = scale_bounds(grid);
  numbers.log_scale = std::clamp(numbers.log_scale, std::log(bounds.least_um), std::log(bounds.most_um));
  numbers.log_height = std::clamp(numbers.log_height, std::log(1e-3), std::log(1e4));
  numbers.hurst = std::clamp(numbers.hurst, 0.0, 1.0);
  numbers.log_lacunarity = std::clamp(numbers.log_lacunarity, std::log(1.2), std::log(8.0));
  const double log_stretch = std::hypot(numbers.stretch_cos, numbers.stretch_sin);
  const double shrink = log_stretch > std::log(64.0) ? std::log(64.0) / log_stretch : 1.0;
  numbers.stretch_cos *= shrink;
  numbers.stretch_sin *= shrink;
  return numbers;
}

// Without a floor the deepest valleys of a spectrum would have to be followed for ever.
constexpr double least_floor = 1e-9;

std::vector<double> expected(const NoiseModel& model, const NoiseNumbers& numbers, const SeenSpectrum& seen) {
  return expected_density(model, numbers, seen.blocks, seen.grid);
}

// By differences to both sides; the steps are small beside what the data tell apart and large beside the rounding.
Eigen::MatrixXd sensitivity_of(const NoiseModel& model, const NoiseNumbers& numbers, const SeenSpectrum& seen,
                               const std::vector<double>& at) {
  const std::vector<double> values = free_numbers(model, numbers);
  Eigen::MatrixXd result(static_cast<Eigen::Index>(at.size()), static_cast<Eigen::Index>(values.size()));
  for (std::size_t j = 0; j < at.size(); ++j) result(static_cast<Eigen::Index>(j), 0) = 1.0 / at[j];  // the floor's
  for (std::size_t i = 1; i < values.size(); ++i) {
    constexpr double step = 1e-3;
    std::vector<double> up = values, down = values;
    up[i] += step;
    down[i] -= step;
    const std::vector<double> above = expected(model, with_free_numbers(model, numbers, up), seen);
    const std::vector<double> below = expected(model, with_free_numbers(model, numbers, down), seen);
    for (std::size_t j = 0; j < at.size(); ++j)
      result(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(i)) = (above[j] - below[j]) / (2.0 * step * at[j]);
  }
  return result;
}

Eigen::MatrixXd information_of(const Eigen::MatrixXd& sensitivity, const SeenSpectrum& seen) {
  Eigen::VectorXd count(sensitivity.rows());
  for (Eigen::Index j = 0; j < count.size(); ++j) count[j] = seen.blocks[static_cast<std::size_t>(j)].count;
  return sensitivity.transpose() * count.asDiagonal() * sensitivity;
}

Eigen::VectorXd score_of(const Eigen::MatrixXd& sensitivity, const SeenSpectrum& seen, const std::vector<double>& at) {
  Eigen::VectorXd surplus(static_cast<Eigen::Index>(at.size()));
  for (std::size_t j = 0; j < at.size(); ++j)
    surplus[static_cast<Eigen::Index>(j)] = seen.blocks[j].count * (seen.density_um4[j] / at[j] - 1.0);
  return sensitivity.transpose() * surplus;
}

// Solved in units in which the diagonal is 1: the floor has another size than the rest.
Eigen::VectorXd damped_step(const Eigen::MatrixXd& information, const Eigen::VectorXd& score, double damping) {
  const Eigen::VectorXd unit = information.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  Eigen::MatrixXd scaled = unit.asDiagonal() * information * unit.asDiagonal();
  scaled.diagonal().array() += damping;
  return unit.cwiseProduct(Eigen::VectorXd(scaled.ldlt().solve(unit.cwiseProduct(score))));
}

NoiseNumbers moved(const NoiseModel& model, const NoiseNumbers& from, const Eigen::VectorXd& step) {
  std::vector<double> values = free_numbers(model, from);
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] += std::clamp(step[static_cast<Eigen::Index>(i)], i == 0 ? -1e300 : -0.5, i == 0 ? 1e300 : 0.5);
  return with_free_numbers(model, from, values);
}

// Within the bounds of what the view can tell. Without a floor the deepest valleys of a spectrum would have to be
// followed for ever.
NoiseNumbers valid(NoiseNumbers numbers, const SeenSpectrum& seen) {
  const double highest = *std::max_element(seen.density_um4.begin(), seen.density_um4.end());
  numbers.floor = std::max(numbers.floor, least_floor * highest);
  return bounded(numbers, seen.grid);
}

// A number that stands at its bound and would leave it is no part of the step; the others go on as if it were fixed.
void hold_at_bounds(const NoiseFit& fit, const SeenSpectrum& seen, Eigen::MatrixXd& information,
                    Eigen::VectorXd& score) {
  const std::vector<double> values = free_numbers(fit.model, fit.numbers);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    std::vector<double> tried = values;
    tried[i] += score[k] / std::max(information(k, k), 1e-300);
    if (free_numbers(fit.model, valid(with_free_numbers(fit.model, fit.numbers, tried), seen))[i] != values[i])
      continue;
    score[k] = 0.0;
    information.row(k).setZero();
    information.col(k).setZero();
    information(k, k) = 1.0;
  }
}

// The numbers after a step that raises the likelihood; the damping learns from what it takes.
bool climb(NoiseFit& fit, const SeenSpectrum& seen, double& damping, double& gain) {
  Eigen::MatrixXd information = fit.information;
  Eigen::VectorXd score = score_of(fit.sensitivity, seen, fit.expected_um4);
  hold_at_bounds(fit, seen, information, score);
  for (; damping < 1e6; damping *= 10.0) {
    const NoiseNumbers tried = valid(moved(fit.model, fit.numbers, damped_step(information, score, damping)), seen);
    std::vector<double> there = expected(fit.model, tried, seen);
    gain = log_likelihood(seen, there) - fit.log_likelihood;
    if (!(gain >= 0.0)) continue;
    fit.numbers = tried;
    fit.expected_um4 = std::move(there);
    fit.log_likelihood += gain;
    damping = std::max(1e-9, 0.1 * damping);
    return true;
  }
  return false;
}

}  // namespace

ScaleBounds scale_bounds(const Grid& grid) {
  const double width = static_cast<double>(grid.columns) * grid.pitch_x.um();
  const double depth = static_cast<double>(grid.rows) * grid.pitch_y.um();
  return {2.5 * std::max(grid.pitch_x.um(), grid.pitch_y.um()), 0.25 * std::min(width, depth)};
}

double log_likelihood(const SeenSpectrum& seen, const std::vector<double>& expected_um4) {
  double sum = 0.0;
  for (std::size_t j = 0; j < expected_um4.size(); ++j) {
    sum -= seen.blocks[j].count * (std::log(expected_um4[j]) + seen.density_um4[j] / expected_um4[j]);
  }
  return FitView::independent_share * sum;
}

NoiseFit maximise(const NoiseModel& model, const NoiseNumbers& start, const SeenSpectrum& seen, double enough) {
  NoiseFit fit{model, valid(start, seen), 0.0, {}, {}, {}};
  fit.expected_um4 = expected(model, fit.numbers, seen);
  fit.log_likelihood = log_likelihood(seen, fit.expected_um4);
  double damping = 1e-3, gain = 2.0 * enough;
  for (int round = 0; round < most_rounds; ++round) {
    fit.sensitivity = sensitivity_of(model, fit.numbers, seen, fit.expected_um4);
    fit.information = information_of(fit.sensitivity, seen);
    if (gain < enough || !climb(fit, seen, damping, gain)) break;
  }
  return fit;
}

NoiseNumbers step_towards(const NoiseFit& fit, const SeenSpectrum& other) {
  const Eigen::VectorXd score = score_of(fit.sensitivity, other, fit.expected_um4);
  return moved(fit.model, fit.numbers, damped_step(fit.information, score, 1e-12));
}

}  // namespace mezzotint
