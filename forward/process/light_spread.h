#pragma once

#include <functional>
#include <span>
#include <variant>

#include "forward/process/gaussian_spread.h"
#include "forward/process/lorentzian_spread.h"

/// Inside of forward/process.

namespace mezzotint {

/// The light of a pixel spread over sub-pixel samples, as a linear operator on images of one size: made once for a
/// patch, applied as often as wanted, by several threads at once.
using LightSpread = std::variant<GaussianSpread, LorentzianSpread>;

/// @throws InvalidInput for an invalid profile, subsamples outside of 1…16, or more than 2^30 samples.
[[nodiscard]] LightSpread light_spread(std::size_t columns, std::size_t rows, const PrinterProfile& profile,
                                       const ProcessOptions& options);

}  // namespace mezzotint
