#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "forward/base/units.h"

/// Inside of measurement/reflectance: what the ways to evaluate a measurement share.

namespace mezzotint {

/// Weights of the channels in what is asked for; they sum to 1.
using ChannelWeights = std::vector<double>;

inline constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();

/// A direction of the light counts as a listed one within this much.
inline constexpr Angle incidence_tolerance = Angle::from_degrees(0.05);

/// Where a number lies among increasing ones: between `index` and `index + 1`, at that share of the way; at both ends
/// within `slack`. `known` is false outside.
struct Place {
  std::size_t index = 0;
  double share = 0.0;
  bool known = false;
};
[[nodiscard]] Place place_among(std::span<const double> increasing, double value, double slack);

/// Σ weight · value over the samples that count; NaN where one of those was not measured. A weight of 0 asks nothing.
class WeightedSum {
public:
  void add(double weight, double value) {
    if (weight != 0.0) sum_ += weight * value;
  }
  [[nodiscard]] double value() const { return sum_; }

private:
  double sum_ = 0.0;
};

/// An angle in [−π, π].
[[nodiscard]] inline double wrapped(double radians) { return std::remainder(radians, 2.0 * std::numbers::pi); }

}  // namespace mezzotint
