#pragma once

#include "forward/pattern/pattern.h"
#include "forward/process/printer_profile.h"
#include "inverse/target/target.h"

namespace mezzotint {

/// A pattern whose closed-form slopes, after the pixel transfer, are those of a target: where a search
/// begins. It matters more than the choice of the algorithm. A start only: the blur acts on light, not on
/// height, and a noise has no single wavelength.
///
/// Only lengths along the surface, stretch and direction are chosen; height, skew, octaves and everything random are
/// taken from `pattern`. Ridges have one slope: the steeper one is matched. A composition stays as it is.
/// The ground's octaves that are geometry at `wavelength` bring a part of the slopes.
[[nodiscard]] Pattern closed_form_start(Pattern pattern, const Target& target, const PrinterProfile& printer,
                                        Length wavelength);

}  // namespace mezzotint
