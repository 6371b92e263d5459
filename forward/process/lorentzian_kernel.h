#pragma once

#include <cstddef>
#include <vector>

#include "forward/process/gaussian_spread.h"

/// Inside of forward/process.

namespace mezzotint {

/// Light from a rectangle of even brightness 1 under the kernel w/(2π (r² + w²)^(3/2)), seen from the origin:
/// differences of atan(x·y/(w·√(x² + y² + w²)))/2π at its corners; and its derivatives, toward w and toward where it is
/// seen from.
struct LorentzianKernel {
  double width;  ///< in pixels, as all lengths here

  [[nodiscard]] double corner(LightPart part, double x, double y) const;
};

/// Where a sample lies, and the pixels around it.
struct WeightPlane {
  std::size_t columns = 0, rows = 0;
  double position_x = 0.5, position_y = 0.5;  ///< of the sample within its pixel, 0 … 1
  bool periodic = false;
};

/// The weights of all pixels of a plane: entry (column, row) is that of the pixel so many places further, counted round
/// the plane.
///
/// Periodic  the nearest copies of each pixel are added, and what lies beyond as if it were smeared out.
/// Sum       1 (0 for a derivative) where periodic; less where not.
[[nodiscard]] std::vector<double> lorentzian_weights(const LorentzianKernel& kernel, LightPart part,
                                                     const WeightPlane& plane);

}  // namespace mezzotint
