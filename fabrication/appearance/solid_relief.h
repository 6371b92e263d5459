#pragma once

#include "fabrication/appearance/relief_probe.h"
#include "forward/pattern/pattern.h"

namespace mezzotint {

/// A noise-like pattern carved out of a block that holds the part: sampled in space at the surface's points, so that it
/// goes around corners without a seam, whatever the part's shape.
///
/// Frame    the part's own, in µm.
/// Errors   InvalidInput for a kind other than noise, fBm and turbulence, or one that is stretched: a block has no
///          direction along its surface.
/// Source   Frisvad 2019, slides "Noise"; Perlin, "An image synthesizer", SIGGRAPH 1985.
[[nodiscard]] SurfaceRelief solid_relief(const Pattern& pattern);

}  // namespace mezzotint
