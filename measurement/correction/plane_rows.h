#pragma once

#include <span>

#include "forward/surface/height_field.h"
#include "measurement/correction/plane.h"
#include "measurement/correction/row_kernels.h"

/// Inside of measurement/correction.

namespace mezzotint {

inline std::span<const float> row_of(const HeightField& field, std::size_t row) {
  return field.heights_um().subspan(row * field.columns(), field.columns());
}
inline std::span<float> row_of(HeightField& field, std::size_t row) {
  return field.heights_um().subspan(row * field.columns(), field.columns());
}

/// x and y of a sample from the middle of the field, in µm.
inline double centred_um(std::size_t index, std::size_t count, Length pitch) {
  return (static_cast<double>(index) - 0.5 * static_cast<double>(count - 1)) * pitch.um();
}

/// A plane along a row.
inline RowLine line_of(const Plane& plane, const HeightField& field, std::size_t row) {
  const Grid& grid = field.grid();
  return {plane.offset.um() + plane.slope_x * centred_um(0, grid.columns, grid.pitch_x) +
              plane.slope_y * centred_um(row, grid.rows, grid.pitch_y),
          plane.slope_x * grid.pitch_x.um()};
}

}  // namespace mezzotint
