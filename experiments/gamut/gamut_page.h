#pragma once

#include "experiments/gamut/gamut_findings.h"
#include "experiments/report/report.h"

namespace mezzotint {

/// The page of a gamut: what was asked and whether it can be printed, the chart of all kinds, each kind at several
/// blurs, and how certain all of it is.
[[nodiscard]] Report gamut_page(const GamutFindings& findings);

}  // namespace mezzotint
