#pragma once

#include "forward/scattering/batch_tally.h"
#include "forward/scattering/correction_plan.h"
#include "forward/scattering/path_tracing.h"
#include "forward/tracing/periodic_tile.h"
#include "forward/tracing/relief_tracer.h"

namespace mezzotint {

/// A splat, and the plan of what corrects it.
struct PlannedSplat {
  CorrectionPlan plan;
  BatchTally splat;
};

/// A tally with the maps that the options ask for.
[[nodiscard]] BatchTally empty_tally(const PathTracingOptions& options);

/// The dense splat of all facets, nothing shadowed.
[[nodiscard]] BatchTally splat_all(const PeriodicTile& tile, const ReliefTracer& tracer,
                                   const PathTracingOptions& options);

/// The splat of what is lit and goes out unhindered, as far as a sweep and a pilot can tell, and the plan for the rest.
/// A function of the relief, the light, the material and the grid: not of the seed or the budget, so that a run that is
/// taken up again makes the same.
[[nodiscard]] PlannedSplat plan_splat(const PeriodicTile& tile, const ReliefTracer& tracer,
                                      const PathTracingOptions& options);

}  // namespace mezzotint
