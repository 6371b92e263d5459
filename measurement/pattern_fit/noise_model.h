#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "forward/pattern/pattern.h"
#include "measurement/pattern_fit/fit_view.h"

/// Inside of measurement/pattern_fit.

namespace mezzotint {

/// Which of the noise-like patterns, and which of its numbers are free.
struct NoiseModel {
  int octaves = 1;  ///< 1: `noise`; more: `fbm`
  bool stretched = true;
  bool free_lacunarity = false;  ///< else 2

  [[nodiscard]] std::size_t size() const;
};

/// The numbers of a fit. They are such that a likelihood is nearly quadratic in them and nothing is singular where the
/// pattern is alike in all directions.
///
///     floor          density of white noise, µm⁴
///     log_height     ln(height/µm)
///     log_scale      ln √(scale · scale·stretch) / µm
///     stretch_cos, stretch_sin   ln(stretch) · (cos, sin)(2·direction)
///     hurst, log_lacunarity
struct NoiseNumbers {
  double floor = 0.0, log_height = 0.0, log_scale = 0.0, stretch_cos = 0.0, stretch_sin = 0.0, hurst = 0.8,
         log_lacunarity = 0.6931471805599453;
};

/// Its free numbers as a list, in the order above, and back.
[[nodiscard]] std::vector<double> free_numbers(const NoiseModel& model, const NoiseNumbers& numbers);
[[nodiscard]] NoiseNumbers with_free_numbers(const NoiseModel& model, NoiseNumbers numbers,
                                             const std::vector<double>& values);

[[nodiscard]] Pattern pattern_of(const NoiseModel& model, const NoiseNumbers& numbers);

/// The expected periodogram in µm⁴ at the blocks' frequencies, on the samples' own grid (what is finer than they are
/// comes back as something coarser), with the white floor.
[[nodiscard]] std::vector<double> expected_density(const NoiseModel& model, const NoiseNumbers& numbers,
                                                   const std::vector<FrequencyBlock>& blocks, const Grid& grid);

/// Frequencies in cycles a cell of the coarsest octave, along `direction` and across.
struct CellFrequency {
  double u, v;
};
[[nodiscard]] CellFrequency in_cells(const NoiseNumbers& numbers, const FrequencyBlock& block);

/// Lengths of a cell along and across `direction`, µm.
struct CellSize {
  double along, across;
};
[[nodiscard]] CellSize cell_size_um(const NoiseNumbers& numbers);

}  // namespace mezzotint
