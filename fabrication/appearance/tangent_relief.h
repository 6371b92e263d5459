#pragma once

#include <memory>
#include <vector>

#include "fabrication/appearance/direction_field.h"
#include "fabrication/appearance/relief_probe.h"
#include "fabrication/appearance/surface_phase.h"
#include "forward/pattern/pattern.h"

namespace mezzotint {

/// A surface with a field of lines on it, on which patterns lie as on their plane.
struct FieldSurface {
  SmoothSurface surface;
  DirectionField field;
};

struct TangentRelief {
  SurfaceRelief relief;
  std::vector<PhaseFigures> waves;  ///< of ridges one, of sinusoids two: along the direction, and across it
};

/// A pattern that lies in the surface: its x axis is the field's line, its y axis the tangent across, counter-clockwise
/// seen from outside; `direction` turns it from there, as in the plane.
///
/// Noise, fBm, turbulence   in space, with impulses that are drawn out along the surface by `stretch`.
/// Line integral convolution  in space, smeared along the straight tangent; right where field and surface bend with
/// radii
///                          above length²/(2.4·scale).
/// Ridges, sinusoids        by phases that keep the wavelength as well as the surface allows (`SurfacePhase`).
/// Errors   InvalidInput for compositions, ridges with a skew (a line has no head: it would point either way), line
///          integral convolution with singularities of its own (the field has them).
[[nodiscard]] TangentRelief tangent_relief(const Pattern& pattern, const std::shared_ptr<const FieldSurface>& on);

/// The longest edge that a surface may have for such a pattern: its phases are linear within triangles. None for noise.
[[nodiscard]] std::optional<Length> longest_edge_for(const Pattern& pattern);

}  // namespace mezzotint
