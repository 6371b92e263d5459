#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "forward/optics/direction.h"

namespace mezzotint {

/// Bins of the directions of one hemisphere in orthographic projection.
///
/// Frame    direction (x, y, z) lies in column ⌊(x+1)W/2⌋, row ⌊(y+1)H/2⌋; row 0 is y = −1. x = +1 belongs
///          to the last bin. The sign of z is not part of the map: one map a hemisphere.
/// Shape    width × height bins, row after row; bins whose pixel does not meet the disc exist, with area 0.
/// Source   Frisvad 2019, slide "BRDF measurement"; rim bins exact (the slides' constant is wrong there).
struct DirectionGrid {
  std::size_t width = 64;
  std::size_t height = 64;

  [[nodiscard]] std::size_t size() const { return width * height; }
  /// The bin of a direction; |(x, y)| ≤ 1 is the caller's promise.
  [[nodiscard]] std::size_t bin_of(double x, double y) const;
  bool operator==(const DirectionGrid&) const = default;
};

/// @throws InvalidInput for a grid without bins or with more than 4096 a side.
void require_valid(const DirectionGrid& grid);

/// One value a bin.
using DirectionMap = std::vector<double>;

/// Projected solid angles Ω cosΘ of all bins: the exact area of pixel ∩ unit disc. They sum to π.
/// @throws InvalidInput for a grid without bins or with more than 4096 a side.
[[nodiscard]] std::vector<double> projected_solid_angles(const DirectionGrid& grid);

/// The mean of a function of direction over pixel ∩ disc of every bin, upper hemisphere, at
/// `samples` × `samples` points a bin (up to twice as many on the rim, four times on an axis inside a
/// bin); on the rim they are laid out over the part that lies in the disc, however small it is. The
/// error falls as 1/samples² for a smooth function; a narrow peak between the points is missed.
/// Bins outside of the disc get 0.
/// @throws InvalidInput for a bad grid, and for `samples` outside of 1 … 1024.
[[nodiscard]] DirectionMap average_over_bins(const DirectionGrid& grid,
                                             const std::function<double(const Direction&)>& function,
                                             std::size_t samples = 16);

/// A map that was estimated: its mean, its standard error, and the means of two independent halves. Where it was
/// estimated from hits also a 95 % interval a bin, which holds where a standard error does not: in bins of few hits or
/// none. Empty for maps that are exact, and for those by order of interaction.
struct MapEstimate {
  DirectionMap mean;
  DirectionMap standard_error;
  DirectionMap half_a;
  DirectionMap half_b;
  DirectionMap low_95, high_95;
};

/// A dimensionless figure with its standard error.
struct Estimate {
  double value = 0.0;
  double standard_error = 0.0;
};

/// relative_l2 = √(Σ a (f − g)² / Σ a g²), a = pixel ∩ disc: cosine-weighted. `plain` holds the noise of
/// f (biased upward); `corrected` takes the product of two independent halves, (f_a − g)(f_b − g), in
/// place of the square, and is 0 where the noise exceeds the difference; its standard error follows from
/// those of the bins. `floor` is what noise alone would give. Bins outside of the disc are left out.
/// @throws InvalidInput for maps that do not fit the grid, or a reference that is zero or lost in noise.
struct MapDifference {
  Estimate corrected;
  double plain = 0.0;
  double floor = 0.0;
};
/// A reference that is exact (a closed form).
[[nodiscard]] MapDifference relative_l2(const DirectionGrid& grid, const MapEstimate& f, const DirectionMap& g);
/// A reference that is itself estimated, independently of f.
[[nodiscard]] MapDifference relative_l2(const DirectionGrid& grid, const MapEstimate& f, const MapEstimate& g);
/// Two exact maps.
[[nodiscard]] double relative_l2(const DirectionGrid& grid, const DirectionMap& f, const DirectionMap& g);

}  // namespace mezzotint
