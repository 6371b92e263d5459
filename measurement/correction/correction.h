#pragma once

#include <cstddef>

#include "forward/surface/height_field.h"

namespace mezzotint {

/// A plane a + b·x + c·y through heights, x and y in micrometres from the middle of the field.
struct Plane {
  Length offset;
  double slope_x = 0.0;
  double slope_y = 0.0;
};

/// Least-squares plane through the measured samples.
/// @throws InvalidInput where fewer than three samples that span a plane are left.
[[nodiscard]] Plane fit_plane(const HeightField& field);
/// The field with a plane subtracted (in double); the plane's offset goes to the datum. A periodic field stays
/// periodic only under a level plane: a tilt has no period.
[[nodiscard]] HeightField subtract_plane(const HeightField& field, const Plane& plane);
/// Levelled by the least-squares plane.
[[nodiscard]] HeightField level(const HeightField& field);

/// A field without its outliers: samples further than `k` standard deviations from the mean (after the
/// least-squares plane) become missing. Returns how many.
struct OutlierResult {
  HeightField field;
  std::size_t removed = 0;
};
/// @throws InvalidInput for k not in [1, 100].
[[nodiscard]] OutlierResult mask_outliers(const HeightField& field, double k);

/// Missing samples replaced by the solution of Laplace's equation with the measured ones as boundary values
/// (dx ≠ dy respected; zero normal derivative at the ends of a patch, wrapped for a periodic one).
/// Exact sparse Cholesky solution. Returns the field whole.
/// @throws InvalidInput when no sample was measured at all.
[[nodiscard]] HeightField fill_missing(const HeightField& field);

}  // namespace mezzotint
