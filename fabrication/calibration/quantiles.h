#pragma once

/// Inside of fabrication/calibration: the distributions that a fit is judged by.

namespace mezzotint {

/// ln Φ(z) of the standard normal distribution, and φ(z)/Φ(z), its slope; also far out on the left.
struct LogNormal {
  double log_probability, slope;
};
[[nodiscard]] LogNormal log_normal_probability(double z);

/// The z below which a standard normal number lies with probability p.
[[nodiscard]] double normal_quantile(double p);
/// The same of Student's distribution.
[[nodiscard]] double student_quantile(double p, double degrees_of_freedom);
/// Chance of a χ² at least as large.
[[nodiscard]] double chi_squared_chance(double chi_squared, double degrees_of_freedom);

}  // namespace mezzotint
