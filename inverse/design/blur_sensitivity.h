#pragma once

#include <vector>

#include "inverse/design/design.h"

namespace mezzotint {

/// A design printed by a printer whose light spreads more or less than its profile says.
struct BlurredPrint {
  double factor = 1.0;         ///< times the profile's width of the spread
  Length width;                ///< of the spread
  SlopeCovariance covariance;  ///< mean over the draws
  SlopeAxesEstimate slopes;    ///< with standard errors over the draws
  double lowered = 0.0;        ///< what the last stage of the search lowered, as a square; the target stays as it was
};

/// How much of an answer hangs on the blur, the least known number of a printer's profile: the design's fresh draws,
/// quantised and on their own grounds, printed again with other widths. The gray layer stays the same, and so do draws,
/// grounds and sample places: what differs between the rows is the blur alone.
///
/// @param factors  of the width, each above 0
/// @throws InvalidInput for no factor, one that is not positive, or as `find_design`.
[[nodiscard]] std::vector<BlurredPrint> blur_sensitivity(const DesignProblem& problem, const Design& design,
                                                         const std::vector<double>& factors = {0.7, 1.0, 1.3});

/// The same of a gray image that is no pattern's; `lowered` is the cube root's square, by slopes alone.
/// @param seeds  of the printed draws, at least 4
[[nodiscard]] std::vector<BlurredPrint> blur_sensitivity(const GrayImage& gray, const PrinterProfile& printer,
                                                         const LobeTarget& goal, const DrawOptions& draw,
                                                         const std::vector<std::uint64_t>& seeds,
                                                         const std::vector<double>& factors = {0.7, 1.0, 1.3});

}  // namespace mezzotint
