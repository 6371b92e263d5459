#pragma once

#include <string>
#include <vector>

#include "forward/scattering/path_tracing.h"
#include "forward/tracing/periodic_tile.h"

namespace mezzotint {

/// What a traced result has to warn of: light that stands in no map (cut off, lost, met beyond the patch), normals that
/// could not be used, an estimator that creates energy, a tolerance that the budget did not reach, bins too coarse for
/// the lobe. By what stands in the result and its provenance, so that each sentence can be checked in the file.
/// A mesh says by itself where its light was lost.
[[nodiscard]] std::vector<std::string> trace_warnings(const PathTracingOptions& options, const Bsdf& bsdf,
                                                      bool is_mesh = false);

/// The light that all facets would catch if none stood in another's shadow, for each light that comes in; what is above
/// 1 is shadowed in truth. From up to 64 rows.
[[nodiscard]] double caught_light(const PeriodicTile& tile, const DirectionAngles& incidence);

/// The same for a splat alone: what it creates for want of shadows, and what it loses for want of further interactions.
/// Either may hide the other in their sum.
[[nodiscard]] std::vector<std::string> splat_warnings(const Bsdf& bsdf, double caught);

}  // namespace mezzotint
