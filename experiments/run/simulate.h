#pragma once

#include "experiments/configuration/experiment_file.h"
#include "forward/base/progress.h"
#include "forward/optics/bsdf.h"
#include "forward/scattering/path_tracing.h"

namespace mezzotint {

/// Relative standard error of a map: √(Σ a·se² / Σ a·f²), a = pixel ∩ disc.
[[nodiscard]] double relative_error(const DirectionGrid& grid, const MapEstimate& map);

/// The BSDF of a relief to a wanted relative standard error of its reflection: a pilot of `least_samples` paths
/// tells how many are needed (error ∝ N^−½), and these are traced anew with another seed, up to
/// `most_samples`. What was reached stands in the provenance as "relative_standard_error".
[[nodiscard]] Bsdf simulate(PathTracer& relief, const SimulationSpecification& simulation,
                            const DirectionAngles& incidence, std::uint64_t seed, const Progress& progress = {});

}  // namespace mezzotint
