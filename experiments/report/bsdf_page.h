#pragma once

#include <string>

#include "experiments/report/report.h"

namespace mezzotint {

/// What the page of a BSDF says besides the BSDF itself.
struct BsdfPageOptions {
  std::string source;           ///< what it is the BSDF of
  double tolerance = 0.0;       ///< that was asked for; 0: none
  double relative_error = 0.0;  ///< relative standard error of the reflection
};

/// The page of one BSDF: maps, energy audit, the error while it was traced, why its model was chosen, warnings.
[[nodiscard]] Report bsdf_page(const Bsdf& bsdf, const BsdfPageOptions& options);

}  // namespace mezzotint
