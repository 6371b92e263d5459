#pragma once

#include <optional>

#include "forward/pattern/pattern.h"
#include "forward/process/printer_profile.h"
#include "forward/surface/slope_covariance.h"

namespace mezzotint {

/// The slope covariance of a printed pattern by its moments alone, without a relief: closed-form slopes of its waves,
/// each let through by pixel and blur as far as its wavelength allows, and the ground's. Microseconds; a start, not the
/// truth: the blur acts on light before the logarithm, a noise has no single wavelength, and what is cut at a layer's
/// top is not seen.
///
/// None for what has no such form: a line field with singularities, masks, regions and products.
[[nodiscard]] std::optional<SlopeCovariance> printed_moments(const Pattern& pattern, const PrinterProfile& printer,
                                                             Length wavelength);

/// The slopes of sparse convolution noise sit at wavelengths of about so many cells.
inline constexpr double noise_wavelength_per_scale = 1.3;

}  // namespace mezzotint
