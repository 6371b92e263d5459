#pragma once

#include <Eigen/Core>

#include "forward/surface/slope_covariance.h"

/// Inside of inverse.

namespace mezzotint {

[[nodiscard]] inline Eigen::Matrix2d matrix_of(const SlopeCovariance& covariance) {
  Eigen::Matrix2d matrix;
  matrix << covariance.xx, covariance.xy, covariance.xy, covariance.yy;
  return matrix;
}

}  // namespace mezzotint
