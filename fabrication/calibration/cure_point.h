#pragma once

#include <optional>
#include <string>

namespace mezzotint {

/// The height of one step of a wedge, over what lies under it.
struct CurePoint {
  double gray = 0.0;      ///< in [0, 1]
  double exposure = 1.0;  ///< how long it was lit, in the profile's own exposures
  double height_um = 0.0;
  /// Of the height; none: not known, and the same for all but for `repeats`.
  std::optional<double> standard_error_um;
  double repeats = 1.0;  ///< how many such measurements the height is the mean of, where no error is known
  std::string place;     ///< where it comes from: "line 7", "step 3"
};

}  // namespace mezzotint
