#pragma once

#include <cstddef>
#include <limits>
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
  bool windowed = false;  ///< a patch: neighbouring frequencies are then correlated

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

/// Mean density over rings |f|, one frequency step (of the longer side) wide each; the mean's standard error from the
/// scatter within the ring (each frequency of a Gaussian surface is exponentially distributed and independent of the
/// others; S(−f) = S(f) counts once; Hann's window leaves 1/1.87 as many that are independent).
struct RadialSpectrum {
  std::vector<double> frequency_per_um;
  std::vector<double> density_um4, standard_error_um4;
};
[[nodiscard]] RadialSpectrum radial_spectrum(const PowerSpectrum& spectrum);

/// Frequencies that count for directions: from `least_per_um` (form, window) to `most_per_um`.
struct AngularLimits {
  double least_per_um = 0.0;
  double most_per_um = std::numeric_limits<double>::infinity();
};

/// Power by the direction of the wave vector, from 0° up to, but not including, 180°, counter-clockwise from +x: shares
/// of the power within the limits that sum to 1.
/// How      the spectrum's integral along rays from the middle, were it interpolated bilinearly: each frequency's power
///          is spread over the directions that its cell takes up. (Counted in the direction of its middle alone, white
///          noise would have its strongest direction along an axis, where most middles lie.) So a field of few waves
///          resolves directions coarsely.
struct AngularSpectrum {
  std::vector<double> share;  ///< of direction k·180°/size
};
/// @throws InvalidInput where no power is within the limits.
[[nodiscard]] AngularSpectrum angular_spectrum(const PowerSpectrum& spectrum, const AngularLimits& limits = {},
                                               std::size_t directions = 180);

/// The share of Sq² that is within the limits; 0 for a flat field.
[[nodiscard]] double angular_power_share(const PowerSpectrum& spectrum, const AngularLimits& limits);

}  // namespace mezzotint
