#pragma once

#include <optional>

#include "forward/pattern/pattern.h"
#include "forward/surface/height_field.h"

namespace mezzotint {

/// Slope covariance of heights given at points, about the mean slope, by differences of the sixth order along both
/// axes: right to (k·pitch)⁶/140 of a wave number k. Three samples along each edge have none and are left out.
/// @throws InvalidInput for a field of fewer than 16 samples a side.
[[nodiscard]] SlopeCovariance point_slope_covariance(const HeightField& heights);

/// The covariance that a noise's slopes have in the mean over all its draws, before printing: of noise, fBm, and sums
/// and turns of them, where `pitch` samples them well. None for what is not smooth (ridges, turbulence), has no closed
/// form that is exact (line integral convolution), or no randomness that draws could be off by (waves).
[[nodiscard]] std::optional<SlopeCovariance> smooth_expectation(const Pattern& pattern, Length pitch);

/// The symmetric B of to = B·from·B.
[[nodiscard]] SlopeCovariance symmetric_factor(const SlopeCovariance& from, const SlopeCovariance& to);
/// B·c·B.
[[nodiscard]] SlopeCovariance through(const SlopeCovariance& factor, const SlopeCovariance& c);

}  // namespace mezzotint
