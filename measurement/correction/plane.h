#pragma once

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
[[nodiscard]] HeightField subtract_plane(HeightField field, const Plane& plane);
/// Levelled by the least-squares plane. A field that is moved in is levelled where it stands, without a copy, as by
/// every correction that takes its field by value.
[[nodiscard]] HeightField level(HeightField field);

}  // namespace mezzotint
