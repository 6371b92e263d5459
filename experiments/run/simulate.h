#pragma once

#include "experiments/configuration/experiment_file.h"
#include "forward/base/progress.h"
#include "forward/optics/bsdf.h"
#include "forward/scattering/path_tracing.h"

namespace mezzotint {

/// The BSDF of a relief to the wanted relative standard error of its reflection, with at most `most_samples` paths.
/// What was reached stands in the provenance as "relative_standard_error" and "model".
[[nodiscard]] Bsdf simulate(const HeightField& field, PathTracer& relief, const SimulationSpecification& simulation,
                            const DirectionAngles& incidence, std::uint64_t seed, const Progress& progress = {});

}  // namespace mezzotint
