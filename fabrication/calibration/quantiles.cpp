#include "fabrication/calibration/quantiles.h"

#include <cmath>
#include <numbers>

#include <unsupported/Eigen/SpecialFunctions>

namespace mezzotint {

LogNormal log_normal_probability(double z) {
  const double density = std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi);
  if (z > -30.0) {
    const double probability = 0.5 * std::erfc(-z / std::numbers::sqrt2);
    return {z > 5.0 ? std::log1p(-0.5 * std::erfc(z / std::numbers::sqrt2)) : std::log(probability),
            density / probability};
  }
  // Mills' ratio: Φ(z) ≈ φ(z)/|z| · (1 − 1/z²), to 1e-5 here.
  const double correction = 1.0 - 1.0 / (z * z);
  return {-0.5 * z * z - std::log(-z * std::sqrt(2.0 * std::numbers::pi)) + std::log(correction), -z / correction};
}

double normal_quantile(double p) { return Eigen::numext::ndtri(p); }

double student_quantile(double p, double degrees_of_freedom) {
  if (p < 0.5) return -student_quantile(1.0 - p, degrees_of_freedom);
  const auto below = [&](double t) {
    const double x = degrees_of_freedom / (degrees_of_freedom + t * t);
    return 1.0 - 0.5 * Eigen::numext::betainc(0.5 * degrees_of_freedom, 0.5, x);
  };
  double low = 0.0, high = 1.0;
  while (below(high) < p) high *= 2.0;
  for (int i = 0; i < 80; ++i) {
    const double middle = 0.5 * (low + high);
    (below(middle) < p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double chi_squared_chance(double chi_squared, double degrees_of_freedom) {
  if (degrees_of_freedom <= 0.0) return 1.0;
  return Eigen::numext::igammac(0.5 * degrees_of_freedom, 0.5 * chi_squared);
}

}  // namespace mezzotint
