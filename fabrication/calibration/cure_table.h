#pragma once

#include <filesystem>
#include <vector>

#include "fabrication/calibration/cure_point.h"

namespace mezzotint {

/// How the numbers of a table are to be taken.
struct CureTableOptions {
  double exposure_s = 3.0;  ///< the profile's own: that of rows which say none
};

/// Measured heights of a wedge from a text table (.csv): one step a line under a line of names.
///
/// Columns  height_um (or _nm, _mm)                                   height over the base
///          gray (0 … 1, or 0 … 255 where a value is above 1), level or gray_level or gray_255 (always 0 … 255)
///          exposure_s (or _ms)                                        optional
///          standard_error_um (or error_um, se_um; _nm, _mm)           optional
///          standard_deviation_um (or sd_um) with repeats (or n)       optional: its standard error is sd/√n
///          repeats alone                                              weights of the heights
///          Names are taken in any case and order, with blanks, "-" or "_", and units in brackets: "Height [µm]".
/// Lines    '#' starts a comment; cells are separated by ';', a tab, ',' or blanks; numbers have decimal points. A
///          cell of the height that is empty or NaN leaves the step out.
/// @throws  FileError with line and what would be right: a column missing, twice or unknown, a number that is none, a
///          height without unit in its name, no steps.
[[nodiscard]] std::vector<CurePoint> read_cure_table(const std::filesystem::path& path,
                                                     const CureTableOptions& options = {});

}  // namespace mezzotint
