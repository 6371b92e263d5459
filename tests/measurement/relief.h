#pragma once

#include <cmath>
#include <cstddef>
#include <limits>

#include "forward/base/random.h"
#include "forward/surface/height_field.h"

namespace mezzotint::test {

inline constexpr float missing = std::numeric_limits<float>::quiet_NaN();

/// A field from a function of column and row.
template <class Height>
HeightField field_of(const Grid& grid, const Height& height_um, Continuation ends = Continuation::Mirrored) {
  HeightField field(grid, ends);
  for (std::size_t row = 0; row < grid.rows; ++row)
    for (std::size_t column = 0; column < grid.columns; ++column)
      field.at(column, row) = static_cast<float>(height_um(static_cast<double>(column), static_cast<double>(row)));
  return field;
}

inline Grid micrometre_grid(std::size_t columns, std::size_t rows) {
  return {columns, rows, Length::from_um(1.0), Length::from_um(1.0)};
}

/// White Gaussian heights of standard deviation 1 µm.
inline HeightField white_noise(const Grid& grid, std::uint64_t seed) {
  const RandomStream random(seed, RandomPurpose::Test);
  HeightField field(grid, Continuation::Mirrored);
  for (std::size_t i = 0; i < grid.size(); ++i) field.heights_um()[i] = static_cast<float>(random.normal4(i)[0]);
  return field;
}

/// Round bumps of 3 µm, 5 µm across, on a lattice of 25 µm: an eighth of what they cover stands out.
inline double bumps_um(double x, double y) {
  const double dx = std::remainder(x, 25.0), dy = std::remainder(y, 25.0);
  return 3.0 * std::max(0.0, 1.0 - (dx * dx + dy * dy) / 6.25);
}

}  // namespace mezzotint::test
