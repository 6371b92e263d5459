#include "measurement/instrument/light_collected.h"

#include <cmath>
#include <numbers>

namespace mezzotint {

double light_collected(double slope, double numerical_aperture) {
  const double apart = slope / std::sqrt(1.0 + slope * slope) / numerical_aperture;
  if (apart >= 1.0) return 0.0;
  return 2.0 / std::numbers::pi * (std::acos(apart) - apart * std::sqrt(1.0 - apart * apart));
}

double probability_at(double light, double probability) {
  if (light == 1.0) return probability;
  if (light == 0.0) return 1.0;
  return probability / (probability + (1.0 - probability) * light);
}

}  // namespace mezzotint
