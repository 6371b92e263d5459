#pragma once

#include <filesystem>

#include "forward/process/printer_profile.h"

namespace mezzotint {

/// A printer profile from a TOML file; keys that are left out keep the slides' printer's values.
///
/// `[blur]` and `[ground]` say `calibrated = true` where a calibration put them; otherwise reports call them
/// assumed.
/// @throws ConfigurationError
[[nodiscard]] PrinterProfile read_printer(const std::filesystem::path& path);

}  // namespace mezzotint
