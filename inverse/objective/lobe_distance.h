#pragma once

#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "inverse/objective/smooth_grid.h"

namespace mezzotint {

/// How far apart two lobes are. All are squares, do not depend on the unit of the lobes, and are 0 for equal ones.
///
/// L2           Σ a (f − g)² / Σ a g². Sees the peak.
/// CubeRoot     Σ a (∛f − ∛g)² / Σ a (∛g)²: the shape, peak and flanks alike.
/// Logarithm    the same with ln(1 + f/g₁), g₁ a hundredth of the highest g: flanks more than the peak.
/// Wasserstein  sliced 2-Wasserstein distance of the lobes' light in the plane of directions, mean over 16 axes, plus
///              the square of the difference of their logarithms of light; in units of g's mean square width. Sees how
///              far light has to be moved, and so has few false minima.
/// Moments      of the light in the plane of directions: squared distance of the means in units of g's own covariance,
///              Förstner and Moonen's distance of the covariances, squared difference of the logarithms of light.
///              Position and width alone; the fewest false minima.
enum class LobeDistance { L2, CubeRoot, Logarithm, Wasserstein, Moments };

inline constexpr std::array all_lobe_distances = {LobeDistance::L2, LobeDistance::CubeRoot, LobeDistance::Logarithm,
                                                  LobeDistance::Wasserstein, LobeDistance::Moments};

/// "l2", "cube_root", "log", "sliced_wasserstein", "moments".
[[nodiscard]] std::string_view name_of(LobeDistance distance);

/// A distance, and its slope toward every bin of f.
struct DistanceWithSlopes {
  double value = 0.0;
  std::vector<double> slopes;  ///< ∂value/∂f
};

/// Distance of a lobe f to one that is wanted, g; both on the same soft bins.
///
/// Edges  where f is 0 the cube root has no slope: a millionth of g's peak is added to f and g.
/// @throws InvalidInput for maps of another grid, a g or an f that is dark everywhere, or values that are negative or
///         not finite.
[[nodiscard]] DistanceWithSlopes lobe_distance(LobeDistance distance, const SmoothGrid& grid, std::span<const double> f,
                                               std::span<const double> g);

}  // namespace mezzotint
