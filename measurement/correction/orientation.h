#pragma once

#include "forward/surface/height_field.h"

namespace mezzotint {

/// Seen in a mirror that stands along y: x runs the other way.
[[nodiscard]] HeightField mirrored_in_x(const HeightField& field);
/// Seen in a mirror that stands along x: y runs the other way.
[[nodiscard]] HeightField mirrored_in_y(const HeightField& field);
/// Turned counter-clockwise by quarter turns, exactly; any whole number. Sample (0, 0) stays at the origin.
[[nodiscard]] HeightField turned_by_quarters(const HeightField& field, int quarters);
/// Turned upside down (z → −z), as a replica of a surface is.
[[nodiscard]] HeightField upside_down(const HeightField& field);

/// The same surface with other spacings, by cubic convolution; where they grow, each height is first averaged over the
/// new cell, so that nothing finer than it comes back as something coarser. The first sample stays where it is; a
/// periodic field must keep its period.
/// @throws InvalidInput for a spacing that is not positive, that leaves fewer than two samples or more than 2^30 of
///         them, or that is no whole part of a period.
[[nodiscard]] HeightField resampled(const HeightField& field, Length pitch_x, Length pitch_y);

/// Turned counter-clockwise about its middle by any angle, on the grid that it had, by cubic convolution. What comes
/// from outside of the field is missing; a periodic field becomes a patch.
[[nodiscard]] HeightField turned(const HeightField& field, Angle angle);

}  // namespace mezzotint
