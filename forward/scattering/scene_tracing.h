#pragma once

#include <string>

#include "forward/base/progress.h"
#include "forward/scattering/path_tracing.h"
#include "forward/tracing/relief_tracer.h"
#include "forward/tracing/scene_frame.h"

/// Inside of forward/scattering: path tracing of a scene that is no relief.

namespace mezzotint {

/// @throws InvalidInput for options out of their ranges (see PathTracer).
void require_valid(const PathTracingOptions& options);

/// Paths through whatever the tracer finds: no splat, no start close to the surface.
/// @param digest  of the scene, for the state on disk.
[[nodiscard]] Bsdf trace_scene(const SceneFrame& frame, const ReliefTracer& tracer, const std::string& digest,
                               const PathTracingOptions& options, const Progress& progress);

}  // namespace mezzotint
