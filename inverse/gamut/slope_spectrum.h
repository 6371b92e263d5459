#pragma once

#include "forward/pattern/pattern.h"
#include "forward/process/printer_profile.h"

namespace mezzotint {

/// Mean square slopes along a pattern's own axes: u, that of its direction, and v. Without ground.
struct AxisSquares {
  double u = 0.0;
  double v = 0.0;
};

/// Slopes after pixel and blur, as if light were height: every wave of the pattern's spectrum times its transfer. In
/// closed form, in microseconds; the cure curve makes a print differ from it by some 10 %, by 30 % where it is steep
/// and fine.
///
/// Kinds    noise, fbm, line integral convolution without singularities, sinusoid, ridges, and sums of them in one
///          direction.
/// Source   noise_spectral_density; Fourier series of the periodic kinds; pixel and blur as `pixel_transfer`.
/// @throws InvalidInput for another kind.
[[nodiscard]] AxisSquares linear_print_slopes(const Pattern& pattern, const PrinterProfile& printer);

/// Slopes as differences of neighbouring pixels' heights: each wave times sinc of its phase over a pixel. What
/// `slope_covariance` of a field with one height a pixel expects, for a pattern of direction 0.
[[nodiscard]] AxisSquares pixel_difference_slopes(const Pattern& pattern, const PrinterProfile& printer);

}  // namespace mezzotint
