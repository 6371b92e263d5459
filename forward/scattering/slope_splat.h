#pragma once

#include "forward/optics/direction_map.h"
#include "forward/optics/material.h"
#include "forward/surface/height_field.h"

namespace mezzotint {

/// Single reflection by the facets of a relief, each with the light that its slope alone would catch: no rays, so
/// no shadows, no masking and no second bounce. Milliseconds where tracing takes seconds.
///
/// What it is for: searches on gentle relief, where what it leaves out is the same for target and print. It
/// creates energy at grazing incidence (9 % at 80° for an RMS gradient of 0.3); use PathTracer for a result.
/// Frame    as DirectionGrid, upper hemisphere; the relief's mean slope is taken as it is (level it first).
/// Missing  cells with a missing corner are left out.
/// @throws InvalidInput for light at or below the horizon, or a relief without a whole cell.
/// Source   f = 1/(N·Ω cosΘ) Σ F·max(0, ω_i·m)/(m_z cosθ_i) over N facets of equal macro area.
[[nodiscard]] DirectionMap slope_reflection_map(const HeightField& field, const Material& material,
                                                const DirectionAngles& incidence, const DirectionGrid& grid);

}  // namespace mezzotint
