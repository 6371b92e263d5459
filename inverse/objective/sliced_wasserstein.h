#pragma once

#include <span>

#include "inverse/objective/lobe_distance.h"

namespace mezzotint {

/// LobeDistance::Wasserstein.
/// Source  Bonneel, Rabin, Peyré, Pfister, "Sliced and Radon Wasserstein barycenters of measures", JMIV 51 (2015);
/// slopes
///         are Kantorovich potentials, read off the monotone transport along each axis.
[[nodiscard]] DistanceWithSlopes wasserstein_distance(const SmoothGrid& grid, std::span<const double> f,
                                                      std::span<const double> g);

}  // namespace mezzotint
