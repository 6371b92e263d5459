#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "forward/process/printer_profile.h"

namespace mezzotint {

/// A printer profile from a TOML file; keys that are left out keep the slides' printer's values.
///
/// `[blur]` and `[ground]` say `calibrated = true` where a calibration put them; otherwise reports call them
/// assumed. `[calibration]` is what is known of `[cure]`: see `CureRecord`.
/// @throws ConfigurationError
[[nodiscard]] PrinterProfile read_printer(const std::filesystem::path& path);

/// The ends of a 95 % interval; none where the data set no bound.
struct Interval95 {
  std::optional<double> low, high;
};

/// Where a profile's cure curve comes from: its table `[calibration]`.
struct CureRecord {
  std::string source;         ///< name of the file that the heights were in
  std::string source_sha256;  ///< of its bytes
  std::int64_t steps = 0;
  Interval95 alpha_um, beta_um, gamma;
  bool gamma_determined = true;  ///< false: γ is the base profile's, and α and β hold for it
  double chi_squared = 0.0;
  std::int64_t degrees_of_freedom = 0;
};

/// The record of a profile; none where its curve was not calibrated by us.
/// @throws ConfigurationError
[[nodiscard]] std::optional<CureRecord> read_cure_record(const std::filesystem::path& path);

/// A profile as the text of a printer file, which `read_printer` takes back to the last bit.
/// @param comment  lines at its beginning, without their '#'
[[nodiscard]] std::string printer_file_text(const PrinterProfile& profile, const std::optional<CureRecord>& record,
                                            const std::string& comment);

}  // namespace mezzotint
