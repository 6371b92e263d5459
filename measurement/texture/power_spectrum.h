#pragma once

#include <cstddef>
#include <vector>

#include "forward/surface/height_field.h"

namespace mezzotint {

/// The areal power spectral density of heights, and what it is along directions.
///
/// Frame    spatial frequencies in cycles a µm; frequency (k_x − columns/2)/(columns·pitch_x) in column k_x, rows
///          likewise, so that 0 stands in column columns/2. S(−f) = S(f).
/// Units    µm⁴: ∫∫ S df_x df_y = Sq² (without window to rounding, with it but for what the window weighs less).
/// Window   a patch is multiplied by a Hann window (scaled to keep Sq²), since its ends do not fit together; a periodic
///          field is taken as it is.
/// Source   ISO 25178-2:2021, 3.2.9; Elson and Bennett, Applied Optics 34 (1995) for the units.
struct PowerSpectrum {
  std::size_t columns = 0, rows = 0;
  Length pitch_x, pitch_y;
  std::vector<double> density_um4;

  [[nodiscard]] double frequency_x_per_um(std::size_t column) const {
    const std::size_t middle = columns / 2;
    return (static_cast<double>(column) - static_cast<double>(middle)) / (static_cast<double>(columns) * pitch_x.um());
  }
  [[nodiscard]] double frequency_y_per_um(std::size_t row) const {
    const std::size_t middle = rows / 2;
    return (static_cast<double>(row) - static_cast<double>(middle)) / (static_cast<double>(rows) * pitch_y.um());
  }
};

/// @throws InvalidInput for a field with missing samples (fill them first), or with fewer than 4 × 4.
[[nodiscard]] PowerSpectrum power_spectrum(const HeightField& field);

/// Power by the direction of the wave vector, from 0° up to, but not including, 180°, counter-clockwise from +x: shares
/// of Sq² that sum to 1. Frequencies below `least_per_um` are left out (form, window).
struct AngularSpectrum {
  std::vector<double> share;  ///< of direction k·180°/size
};
[[nodiscard]] AngularSpectrum angular_spectrum(const PowerSpectrum& spectrum, double least_per_um = 0.0,
                                               std::size_t directions = 180);

}  // namespace mezzotint
