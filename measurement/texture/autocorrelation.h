#pragma once

#include <cstddef>
#include <vector>

#include "forward/surface/height_field.h"

namespace mezzotint {

/// The normalised areal autocorrelation function f_ACF(t_x, t_y), 1 in its middle.
///
/// Frame    lag (column − centre_x) samples along x, (row − centre_y) along y; f(−t) = f(t).
/// Shape    (2·lag_x + 1) × (2·lag_y + 1) values, row after row: lags up to half of the field along each axis, beyond
///          which too few pairs are left (a periodic field: up to half of a period).
/// How      Σ z z′ over all measured pairs at this lag ÷ their number ÷ Sq², heights about their mean; by FFT.
/// Missing  samples make no pairs.
/// Source   ISO 25178-2:2021, 3.2.8; with the mean over pairs in place of the integral over the whole area, which
///          would pull f to 0 at long lags.
struct Autocorrelation {
  std::size_t lag_x = 0, lag_y = 0;
  Length pitch_x, pitch_y;
  std::vector<double> values;

  [[nodiscard]] double at(std::ptrdiff_t x, std::ptrdiff_t y) const {
    const auto column = static_cast<std::ptrdiff_t>(lag_x) + x, row = static_cast<std::ptrdiff_t>(lag_y) + y;
    return values[static_cast<std::size_t>(row) * (2 * lag_x + 1) + static_cast<std::size_t>(column)];
  }
};

/// @throws InvalidInput for a field of fewer than 2 × 2 samples, or one that is flat or without a measured sample.
[[nodiscard]] Autocorrelation autocorrelation(const HeightField& field);

}  // namespace mezzotint
