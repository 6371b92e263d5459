#pragma once

#include <array>
#include <cstddef>

#include "forward/pattern/pattern.h"

/// Inside of measurement/pattern_fit.

namespace mezzotint {

enum class LineKind { Sinusoid, Ridges };

/// A periodic pattern somewhere on a tilted plane: height · gray(u, v) + a + b·x + c·y.
///
///     u = κ (x cos δ + y sin δ) + phase_u,  v = κ_v (y cos δ − x sin δ) + phase_v,  in waves
///
/// Ridges have no v, and skew; a sinusoid no skew.
struct LineNumbers {
  double waves_u_per_um = 0.0, direction = 0.0, height_um = 0.0, phase_u = 0.0;
  double waves_v_per_um = 0.0, phase_v = 0.0;  ///< sinusoid
  double skew = 0.5;                           ///< ridges
  double offset_um = 0.0, slope_x = 0.0, slope_y = 0.0;
};

inline constexpr std::size_t line_numbers = 10;
using LineGradient = std::array<double, line_numbers>;

/// Its height over a point, and the derivatives by its numbers in the order above (those that a kind lacks are 0).
[[nodiscard]] double line_height(LineKind kind, const LineNumbers& numbers, double x_um, double y_um,
                                 LineGradient& gradient);

[[nodiscard]] std::array<double*, line_numbers> members(LineNumbers& numbers);

/// The same relief in the one form that is reported: of a sinusoid's two directions that within (−45°, 45°], of ridges'
/// that within (−90°, 90°].
[[nodiscard]] LineNumbers in_reported_form(LineKind kind, LineNumbers numbers);

[[nodiscard]] Pattern pattern_of(LineKind kind, const LineNumbers& numbers);

}  // namespace mezzotint
