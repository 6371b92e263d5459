#pragma once

#include <span>
#include <string>
#include <vector>

#include "forward/pattern/pattern.h"

namespace mezzotint {

/// The heights of a pattern, and how they change with some of its numbers.
///
/// Units    µm a unit of the number, as its name says: µm a µm, µm a degree, µm.
struct HeightDerivatives {
  HeightField heights;                     ///< with the bits of `synthesize`
  std::vector<std::vector<float>> toward;  ///< ∂(height)/∂(number) at each sample, one map a name
  std::vector<double> of_height;           ///< ∂(height_of the pattern)/∂(number), one a name
};

/// Exact: noises by the gradient of the noise, all kinds through the map to their own units, compositions by the chain
/// rule. Phases and seeds stay as they are.
///
/// Edges    0 where heights are cut to [0, height_of]. On the crests and in the valleys of ridges, and where turbulence
///          turns back from 0, the derivative of one side. A mask without softness, and the picture of regions, change
///          what is seen by jumps: toward what moves them it is 0.
/// Line integral convolution  by central differences, within about 1e-3; its cost grows with the number of names.
/// @param names  of numbers, by their paths (all_parameters)
/// @throws InvalidInput as `synthesize`, and for a name that the pattern does not have or that is a whole number.
[[nodiscard]] HeightDerivatives synthesize_with_derivatives(const Pattern& pattern, const Grid& grid,
                                                            const Position& origin, std::span<const std::string> names);

}  // namespace mezzotint
