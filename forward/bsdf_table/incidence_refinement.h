#pragma once

#include <optional>
#include <vector>

#include "forward/bsdf_table/build_bsdf_table.h"

/// Inside of forward/bsdf_table: which directions of the light a table is made of.

namespace mezzotint {

struct RefinedIncidences {
  IncidenceGrid grid;
  std::vector<Bsdf> nodes;  ///< full maps, in the order of their computation
  BsdfTableReport report;   ///< what concerns directions of the light
};
[[nodiscard]] RefinedIncidences refine_incidences(const ComputeBsdf& compute, const BsdfTableOptions& options,
                                                  const Progress& progress, const FindBsdf& find);

/// Reflection and transmission made to have the symmetry that the table is promised, where that moves bins to bins:
/// the two sides of the plane of incidence where isotropic and lit along x, and all eight turns and mirrors of a square
/// grid at the normal.
void impose_isotropy(Bsdf& bsdf);

}  // namespace mezzotint
