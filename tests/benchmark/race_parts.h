#pragma once

#include <cmath>

#include "tests/fabrication/slicing/shapes.h"

namespace mezzotint::test {

// The parts of the slicing race, all in millimetres and within the projector's field of 19.3 × 12.1 mm.

inline PartMesh race_sphere() { return sphere({0.0, 0.0, 2.0}, 2.0, 200, 400); }

inline PartMesh race_gear() { return prism(gear(0.0, 0.0, 4.2, 5.2, 40), 0.0, 2.0); }

/// Smooth relief with a little roughness on top, 12 × 10 mm.
inline PartMesh race_plate(std::size_t columns, std::size_t rows) {
  std::vector<std::vector<double>> heights(rows, std::vector<double>(columns));
  std::uint32_t state = 1;
  const double step = 12.0 / static_cast<double>(columns - 1);
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t c = 0; c < columns; ++c) {
      state = state * 1664525U + 1013904223U;
      const double x = static_cast<double>(c) * step, y = static_cast<double>(r) * step;
      heights[r][c] = 1.15 + 0.075 * std::sin(9.0 * x) + 0.075 * std::cos(11.0 * y + 3.0 * x) + 3e-12 * state;
    }
  }
  return plate(heights, step);
}

/// A body that fills the field, 20 mm high.
inline PartMesh race_block() { return box({0.0, 0.0, 0.0}, {19.2, 12.0, 20.0}); }

}  // namespace mezzotint::test
