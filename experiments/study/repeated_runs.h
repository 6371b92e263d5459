#pragma once

#include <vector>

#include "forward/optics/direction_map.h"

/// Inside of experiments/study: what runs that are repeated give together.

namespace mezzotint {

/// CPU time of the process so far.
[[nodiscard]] double cpu_seconds();

[[nodiscard]] double mean_of(const std::vector<double>& values);
/// Standard error of the mean; 0 of a single value.
[[nodiscard]] double error_of_mean(const std::vector<double>& values);
/// The median and its standard error.
[[nodiscard]] Estimate median_of(std::vector<double> values);

}  // namespace mezzotint
