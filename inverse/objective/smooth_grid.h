#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "forward/optics/direction_map.h"

namespace mezzotint {

/// A grid of directions whose bins are soft: each is a quadratic B-spline three bins wide, so that what falls into it
/// changes smoothly with the direction and has a slope. (Hard bins have none; tent bins have kinks.)
///
/// Frame    as DirectionGrid.
/// areas    of the soft bins, ∫ over the unit disc of the spline: what a lobe that is 1 everywhere puts into each.
///          They sum to π. A direction in the outermost half bin counts for the last bin as if a mirror stood on the
///          grid's edge.
/// Source   Unser, "Splines: a perfect fit for signal and image processing", IEEE SPM 16 (1999), for the spline.
class SmoothGrid {
public:
  /// @throws InvalidInput for a bad grid, or one of fewer than 4 or more than 512 bins a side.
  explicit SmoothGrid(const DirectionGrid& grid);

  [[nodiscard]] const DirectionGrid& grid() const { return grid_; }
  [[nodiscard]] const std::vector<double>& areas() const { return areas_; }

  /// A map of hard bins as the soft ones would have it, to the fourth order in a bin's width: smoothed by (1, 10, 1)/12
  /// along both axes, which is what a quadratic spline spreads more than a bin does.
  [[nodiscard]] DirectionMap softened(const DirectionMap& map) const;

  /// A map whose directions scatter besides, with this variance along either axis in squared bins: the printer's own
  /// roughness, in the mean over all its draws. Light that would leave the grid stays in its last bins.
  [[nodiscard]] DirectionMap scattered(const DirectionMap& map, double variance) const;
  /// From ∂J/∂(scattered map) to ∂J/∂(map).
  [[nodiscard]] std::vector<double> scattered_back(const std::vector<double>& derivatives, double variance) const;

private:
  DirectionGrid grid_;
  std::vector<double> areas_;
};

/// The three bins along one axis that a coordinate falls into, with their shares (which sum to 1) and the slopes of
/// these toward the coordinate in bins.
struct SoftBins {
  std::array<std::size_t, 3> bin;
  std::array<double, 3> share, slope;
};

/// @param coordinate  0 at the grid's lower edge, `count` at its upper one
[[nodiscard]] inline SoftBins soft_bins(double coordinate, std::size_t count) {
  const double last = static_cast<double>(count - 1);
  const double nearest = coordinate < 0.0           ? 0.0
                         : coordinate >= last + 1.0 ? last
                                                    : static_cast<double>(int(coordinate));
  const double t = coordinate - nearest - 0.5;  // −½ … ½ from the middle of the nearest bin
  const double low = 0.5 - t, high = 0.5 + t;
  const auto middle = static_cast<std::size_t>(nearest);
  return {{middle == 0 ? 0 : middle - 1, middle, middle + 1 == count ? middle : middle + 1},
          {0.5 * low * low, 0.75 - t * t, 0.5 * high * high},
          {-low, -2.0 * t, high}};
}

}  // namespace mezzotint
