#pragma once

#include <functional>
#include <optional>

#include "fabrication/calibration/cure_fit.h"
#include "forward/base/quantity.h"
#include "forward/process/printer_profile.h"

namespace mezzotint {

/// A number that the curve decides, with the standard error that the fit's covariance gives it.
[[nodiscard]] Quantity derived_quantity(const CureFit& fit, const std::string& unit,
                                        const std::function<double(const CureCurve&)>& figure);

/// A gray level of the printer with the levels that its 95 % interval reaches to.
struct LevelInterval {
  int level = 0, low_95 = 0, high_95 = 0;
};

/// What a printer with this curve can cure in one layer.
struct ReachableRange {
  Quantity threshold;         ///< gray value at which curing begins, in [0, 1]
  LevelInterval first_level;  ///< the first that cures
  Quantity first_height;      ///< of that level: nothing lower can be printed
  Quantity step_at_first;     ///< height from that level to the next
  Quantity step_at_last;      ///< to the last level from the one before, or to the last that does not fill the layer
  Quantity full_height;       ///< of full gray, or the layer where that is less
  /// The first level that fills the layer; none where full gray does not.
  std::optional<LevelInterval> saturation;
};

/// @param printer  for its layer and gray levels; its curve is not used
[[nodiscard]] ReachableRange reachable_range(const CureFit& fit, const PrinterProfile& printer);

}  // namespace mezzotint
