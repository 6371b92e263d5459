#pragma once

#include "measurement/pattern_fit/noise_draws.h"
#include "measurement/pattern_fit/pattern_fit.h"

/// Inside of measurement/pattern_fit.

namespace mezzotint {

/// The pattern of a fit with what its draws say taken off, and its parameters with intervals: lengths and ratios by
/// factors, angles by differences. Student's t, and the draws' own number, widen them.
void report_parameters(const NoiseFit& fit, const NoiseDraws& draws, PatternFit& result);

}  // namespace mezzotint
