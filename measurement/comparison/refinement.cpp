#include "measurement/comparison/refinement.h"

#include <tbb/parallel_for.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace mezzotint {

namespace {

constexpr int most_gauss_newton_steps = 20;

/// Sums over samples, from which the next step and the figures of a fit follow.
struct Sums {
  FitMatrix normal = FitMatrix::Zero();
  FitVector gradient = FitVector::Zero();
  double count = 0.0;
  double residual2 = 0.0;
  double d = 0.0, m = 0.0, dd = 0.0, mm = 0.0, dm = 0.0;

  void add(const SampleFit& sample) {
    const double levelled = sample.design_um + sample.residual_um;
    normal.noalias() += sample.slopes * sample.slopes.transpose();
    gradient += sample.slopes * sample.residual_um;
    count += 1.0;
    residual2 += sample.residual_um * sample.residual_um;
    d += sample.design_um, m += levelled;
    dd += sample.design_um * sample.design_um, mm += levelled * levelled, dm += sample.design_um * levelled;
  }
  void add(const Sums& other) {
    normal += other.normal;
    gradient += other.gradient;
    count += other.count, residual2 += other.residual2;
    d += other.d, m += other.m, dd += other.dd, mm += other.mm, dm += other.dm;
  }
  [[nodiscard]] double correlation() const {
    const double design2 = dd - d * d / count;
    const double measured2 = mm - m * m / count;
    return design2 > 0.0 && measured2 > 0.0 ? (dm - d * m / count) / std::sqrt(design2 * measured2) : 0.0;
  }
  [[nodiscard]] double mean_square() const { return residual2 / std::max(1.0, count); }
};

/// Fixed blocks of rows, added in their order: the same bits with any number of threads.
Sums sum_up(const Matching& matching, const Fit& fit) {
  constexpr std::size_t rows_per_block = 8;
  const std::size_t rows = (matching.measured.rows() + matching.steps.y - 1) / matching.steps.y;
  std::vector<Sums> blocks((rows + rows_per_block - 1) / rows_per_block);
  tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t block) {
    Sums sums;
    const std::size_t end = std::min(rows, (block + 1) * rows_per_block);
    for (std::size_t r = block * rows_per_block; r < end; ++r) {
      for (std::size_t c = 0; c < matching.measured.columns(); c += matching.steps.x) {
        const SampleFit sample = sample_fit(matching, fit, c, r * matching.steps.y);
        if (!std::isnan(sample.residual_um)) sums.add(sample);
      }
    }
    blocks[block] = sums;
  });
  Sums total;
  for (const Sums& block : blocks) total.add(block);
  return total;
}

Fit moved(const Matching& matching, Fit fit, const FitVector& step) {
  const Placement& from = fit.placement;
  fit.placement = Placement(from.centre(), {from.shift().x_um + step[ShiftX], from.shift().y_um + step[ShiftY]},
                            from.rotation() + step[Rotation] / matching.arm_um);
  fit.plane += step.tail<3>();
  return fit;
}

void note_sums(Fit& fit, const Sums& sums) {
  fit.normal = sums.normal;
  fit.samples = sums.count;
  fit.mean_square = sums.mean_square();
  fit.correlation = sums.count > 0.0 ? sums.correlation() : 0.0;
}

/// How far a step moves the surfaces against each other at the arm's length.
double movement_um(const FitVector& step) { return step.head<3>().cwiseAbs().sum(); }

}  // namespace

SampleSteps steps_for(const Grid& grid, double most) {
  SampleSteps steps;
  const auto left = [&] {
    const std::size_t columns = (grid.columns + steps.x - 1) / steps.x;
    const std::size_t rows = (grid.rows + steps.y - 1) / steps.y;
    return columns * rows;
  };
  while (static_cast<double>(left()) > most) ++(steps.x < steps.y ? steps.x : steps.y);
  return steps;
}

SampleFit sample_fit(const Matching& matching, const Fit& fit, std::size_t column, std::size_t row) {
  SampleFit sample;
  const Grid& grid = matching.measured.grid();
  const FieldPoint seen{static_cast<double>(column) * grid.pitch_x.um(), static_cast<double>(row) * grid.pitch_y.um()};
  const FieldPoint point = fit.placement.to_design(seen);
  const SurfacePoint design = surface_at(matching.design, point);
  const double arm = matching.arm_um;
  const double x = (seen.x_um - fit.placement.centre().x_um) / arm;
  const double y = (seen.y_um - fit.placement.centre().y_um) / arm;
  const double plane_um = fit.plane[0] + fit.plane[1] * x + fit.plane[2] * y;
  sample.design_um = design.height_um;
  sample.residual_um = static_cast<double>(matching.measured.at(column, row)) - design.height_um - plane_um;

  // The point of the design under a fixed point of the instrument: its derivatives by shift and rotation.
  const FieldPoint by_shift_x = fit.placement.turn_back({-1.0, 0.0});
  const FieldPoint by_shift_y = fit.placement.turn_back({0.0, -1.0});
  const FieldPoint by_rotation{point.y_um - fit.placement.centre().y_um, fit.placement.centre().x_um - point.x_um};
  const auto along = [&](FieldPoint v) { return design.slope_x * v.x_um + design.slope_y * v.y_um; };
  sample.slopes << along(by_shift_x), along(by_shift_y), along(by_rotation) / arm, 1.0, x, y;
  if (sample.slopes.hasNaN()) sample.residual_um = std::numeric_limits<double>::quiet_NaN();
  return sample;
}

PartialInverse invert_normal(const FitMatrix& normal) {
  // Shifts and rotation share one scale (all move the relief), and so do the plane's three.
  FitVector scale;
  scale.head<3>().setConstant(std::max(normal(ShiftX, ShiftX), normal(ShiftY, ShiftY)));
  scale.tail<3>().setConstant(normal(Offset, Offset));
  scale = scale.cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<FitMatrix> solver(scale.asDiagonal() * normal * scale.asDiagonal());
  // Heights are floats (6e-8), so slopes below 1e-5 of the steepest are their round-off.
  constexpr double open_below = 1e-10;
  PartialInverse result;
  for (int k = 0; k < FitParameterCount; ++k) {
    const FitVector direction = solver.eigenvectors().col(k);
    if (solver.eigenvalues()[k] > open_below) {
      result.inverse += direction * direction.transpose() / solver.eigenvalues()[k];
    } else {
      result.open += direction.cwiseAbs2();
    }
  }
  result.inverse = scale.asDiagonal() * result.inverse * scale.asDiagonal();
  return result;
}

Fit refine(const Matching& matching, const Placement& start, double enough_um) {
  Fit fit;
  fit.placement = start;
  Sums sums = sum_up(matching, fit);
  note_sums(fit, sums);
  for (int k = 0; k < most_gauss_newton_steps && sums.count > static_cast<double>(FitParameterCount); ++k) {
    FitVector step = invert_normal(sums.normal).inverse * sums.gradient;
    bool better = false;
    for (int halving = 0; halving < 4 && !better; ++halving, step *= 0.5) {
      const Fit trial = moved(matching, fit, step);
      const Sums trial_sums = sum_up(matching, trial);
      // Falling out of the overlap also makes the residual small, and is no improvement.
      better = trial_sums.mean_square() <= sums.mean_square() && trial_sums.count > 0.5 * sums.count;
      if (better) fit = trial, sums = trial_sums;
    }
    note_sums(fit, sums);
    if (!better || movement_um(step) < enough_um) break;
  }
  return fit;
}

}  // namespace mezzotint
