#pragma once

#include <cstddef>
#include <vector>

#include "forward/surface/height_field.h"

/// Inside of fabrication/calibration: levelled means over rectangles of a scan.

namespace mezzotint {

/// Samples [column, column_end) × [row, row_end), of a plateau.
struct Patch {
  std::size_t column = 0, column_end = 0, row = 0, row_end = 0;
  std::size_t plateau = 0;
};

struct Tilt {
  double slope_x = 0.0, slope_y = 0.0;  ///< µm a µm
  double error_x = 0.0;                 ///< standard error of slope_x
};

/// A rough tilt, before anything is known of plateaus: of the shortest half of all differences between samples `apart`
/// columns (and rows) from each other, so that steps do not count.
[[nodiscard]] Tilt rough_tilt(const HeightField& field, std::size_t columns_apart, std::size_t rows_apart);

struct PlateauMean {
  double height_um = 0.0, standard_error_um = 0.0;
  double middle_x_um = 0.0;
  std::size_t samples = 0, outliers = 0;
};

struct Levelled {
  Tilt tilt;
  double roughness_um = 0.0;
  std::vector<PlateauMean> plateaus;
};

/// One plane's slopes, and a height for every plateau; samples more than 5 robust standard deviations from their
/// plateau do not count.
/// @param start  a tilt that leaves plateaus flatter than their outliers
[[nodiscard]] Levelled level_plateaus(const HeightField& field, const std::vector<Patch>& patches, std::size_t plateaus,
                                      const Tilt& start);

}  // namespace mezzotint
