#pragma once

#include "forward/process/printed_relief.h"
#include "forward/surface/slope_covariance.h"

namespace mezzotint {

/// Mean and covariance of a printed relief's slopes at its samples.
struct SlopeMoments {
  double mean_x = 0.0, mean_y = 0.0;
  SlopeCovariance covariance;  ///< about the mean
};

/// @throws nothing; of no samples all are NaN.
[[nodiscard]] SlopeMoments slope_moments(const ReliefSlopes& slopes);

}  // namespace mezzotint
