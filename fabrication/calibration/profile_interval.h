#pragma once

#include "fabrication/calibration/cure_likelihood.h"

/// Inside of fabrication/calibration.

namespace mezzotint {

/// Where the loss, least over all other free parameters, stays within `rise` of its minimum; ±∞ where it does up to
/// the ends of what a printer file takes.
struct ProfileInterval {
  double low, high;
  LeastLoss lowest;  ///< the best that was met on the way: below the start's where that was no minimum
};
/// @param parameter  0 … 2 of CureParameters, one of the free ones
[[nodiscard]] ProfileInterval profile_interval(const std::vector<WeighedPoint>& points, const LeastLoss& best,
                                               int parameter, const FreeParameters& free, double rise, double layer_um);

}  // namespace mezzotint
