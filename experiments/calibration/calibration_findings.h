#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/configuration/printer_file.h"
#include "fabrication/calibration/reachable_range.h"
#include "fabrication/calibration/wedge_scan.h"

namespace mezzotint {

/// All that `mezzotint calibrate` found.
struct CalibrationFindings {
  std::string source;         ///< name of the file with the heights
  std::string source_sha256;  ///< of its bytes
  PrinterProfile base;        ///< as it was
  PrinterProfile printer;     ///< with the curve found
  CureFit fit;
  ReachableRange range;
  std::optional<WedgeScan> wedge;  ///< where the heights come from a scan
};

/// What goes into the printer file beside the curve.
[[nodiscard]] CureRecord record_of(const CalibrationFindings& findings);

/// What must be known before the curve is trusted: notes of fit and wedge, full gray that does not reach the layer.
[[nodiscard]] std::vector<std::string> warnings_of(const CalibrationFindings& findings);

/// "17.71 ± 0.04 µm, 95 %: 17.63 to 17.79".
[[nodiscard]] std::string in_words(const FittedNumber& number, const std::string& unit);
/// The lines that the program prints.
[[nodiscard]] std::string in_words(const CalibrationFindings& findings);
/// "level 43 (42 to 44)".
[[nodiscard]] std::string in_words(const LevelInterval& level);

/// Parameters with intervals, range, residuals, wedge. The same bits every time.
[[nodiscard]] nlohmann::ordered_json to_json(const CalibrationFindings& findings);

}  // namespace mezzotint
