#pragma once

#include "experiments/calibration/calibration_findings.h"
#include "experiments/report/report.h"

namespace mezzotint {

/// The page of a calibration: curve with its band and the measured steps, residuals, range, steps; of a scan the
/// profile with the borders that were found.
[[nodiscard]] Report calibration_page(const CalibrationFindings& findings);

}  // namespace mezzotint
