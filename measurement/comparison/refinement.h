#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "forward/surface/height_field.h"
#include "measurement/comparison/placement.h"

namespace mezzotint {

/// What is fitted: a shift and a rotation, and the plane offset + tilt·(p − centre) between the two surfaces.
/// Units    all in micrometres: the rotation and the tilts are those of a point `arm_um` from the centre, so that the
///          six are of one size and their matrix well scaled.
enum FitParameter { ShiftX, ShiftY, Rotation, Offset, TiltX, TiltY, FitParameterCount };
using FitVector = Eigen::Matrix<double, FitParameterCount, 1>;
using FitMatrix = Eigen::Matrix<double, FitParameterCount, FitParameterCount>;

/// Which samples of the measurement are used: every step_x-th of every step_y-th row.
struct SampleSteps {
  std::size_t x = 1;
  std::size_t y = 1;
};

/// The steps that leave at most `most` samples, as even in both axes as can be.
[[nodiscard]] SampleSteps steps_for(const Grid& grid, double most);

/// Two surfaces to be brought together: measured(p) = design(to_design(p)) + plane. The design is interpolated and
/// the measured samples are used as they are: their noise stays white, and does not enter the slopes.
struct Matching {
  const HeightField& design;
  const HeightField& measured;
  SampleSteps steps;
  double arm_um = 1.0;
};

/// A placement and how well it fits.
struct Fit {
  Placement placement;
  Eigen::Vector3d plane = Eigen::Vector3d::Zero();  ///< offset and tilts at the arm, micrometres
  FitMatrix normal = FitMatrix::Zero();             ///< Σ J Jᵀ
  double samples = 0.0;                             ///< where both are known
  double mean_square = 0.0;                         ///< of the residual, µm²
  double correlation = 0.0;                         ///< of design and levelled measurement
};

/// What one sample says at a fit: its residual, and how the prediction changes with each parameter. NaN where
/// design or measurement is missing.
struct SampleFit {
  double residual_um = 0.0;
  double design_um = 0.0;
  FitVector slopes = FitVector::Zero();
};
[[nodiscard]] SampleFit sample_fit(const Matching& matching, const Fit& fit, std::size_t column, std::size_t row);

/// Inverse of a normal matrix on what the surfaces determine. Directions that they leave open (the shift along
/// straight ridges) get no step, and `open` counts how much of each parameter lies in them.
struct PartialInverse {
  FitMatrix inverse = FitMatrix::Zero();
  FitVector open = FitVector::Zero();
};
[[nodiscard]] PartialInverse invert_normal(const FitMatrix& normal);

/// Gauss–Newton with step halving, from a placement that is good to about half a feature, until a step moves the
/// surfaces by less than `enough_um`, or makes nothing better.
[[nodiscard]] Fit refine(const Matching& matching, const Placement& start, double enough_um);

}  // namespace mezzotint
