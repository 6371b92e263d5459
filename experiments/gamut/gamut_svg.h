#pragma once

#include <string>

#include "experiments/gamut/gamut_findings.h"

namespace mezzotint {

/// The chart for a paper: all kinds and the asked targets in one panel, then a panel a kind with the border at the
/// profile's blur and at the others.
[[nodiscard]] std::string gamut_svg(const GamutFindings& findings);

}  // namespace mezzotint
