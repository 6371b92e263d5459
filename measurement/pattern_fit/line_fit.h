#pragma once

#include <optional>

#include "measurement/pattern_fit/fit_view.h"
#include "measurement/pattern_fit/line_model.h"

/// Inside of measurement/pattern_fit.

namespace mezzotint {

/// A periodic pattern through a relief by least squares.
struct LineFit {
  LineKind kind = LineKind::Sinusoid;
  LineNumbers numbers;
  LineNumbers errors;        ///< standard error of each number
  double share_left = 1.0;   ///< mean square of the residual ÷ that of the levelled heights
  double residual_um = 0.0;  ///< its root
  double flatness = 0.0;     ///< probability that white noise is as uneven in rings and sectors as the residual
  double waves = 0.0;        ///< along the shorter side, of the longest wave
};

/// None where the spectrum has no peaks that could be the pattern's.
///
/// Errors   from the least squares' own matrix and the spectral density of the residual around the lines: what noise
///          moves a line is the noise at its frequency (for white noise that is the Cramér–Rao bound). No less than
///          what the rounding of floats leaves.
[[nodiscard]] std::optional<LineFit> fit_lines(LineKind kind, const FitView& view, const HeightField& seen);

}  // namespace mezzotint
