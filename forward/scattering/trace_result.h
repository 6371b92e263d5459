#pragma once

#include "forward/optics/bsdf.h"
#include "forward/scattering/path_tracing.h"
#include "forward/scattering/planned_splat.h"
#include "forward/scattering/trace_state.h"

namespace mezzotint {

struct TraceResult {
  Bsdf bsdf;
};

/// What the tallies of all batches amount to.
/// @param splat   the splat of `facets` facets that the paths only correct; nullptr where they are everything.
/// @throws MethodError where all light met mirrored copies.
[[nodiscard]] TraceResult summarise(const PathTracingOptions& options, const TraceState& state,
                                    const PlannedSplat* splat, double facets);

/// What a splat alone amounts to, divided by its total.
[[nodiscard]] Bsdf splat_result(const PathTracingOptions& options, const BatchTally& splat, double facets);

}  // namespace mezzotint
