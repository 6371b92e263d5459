#pragma once

#include <cmath>
#include <numbers>

#include "tests/fabrication/slicing/shapes.h"

namespace mezzotint::benchmark {

using namespace test;

// The parts of the slicing race, all in millimetres and within the projector's field of 19.3 × 12.1 mm.

inline PartMesh race_sphere() { return sphere({0.0, 0.0, 2.0}, 2.0, 200, 400); }

inline PartMesh race_gear() { return prism(gear(0.0, 0.0, 4.2, 5.2, 40), 0.0, 2.0); }

/// A plate of 12 × 10 mm, 59 layers of 18 µm high, with bumps and dents of 0.1 mm on it, each some five cells wide,
/// and a little roughness: contours by the thousand in every layer of the relief.
inline PartMesh race_plate(std::size_t columns, std::size_t rows) {
  std::vector<std::vector<double>> heights(rows, std::vector<double>(columns));
  std::uint32_t state = 1;
  const double step = 12.0 / static_cast<double>(columns - 1);
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t c = 0; c < columns; ++c) {
      state = state * 1664525U + 1013904223U;
      const double u = static_cast<double>(c) / 5.3, v = static_cast<double>(r) / 5.3;
      const double wave = std::sin(2.0 * std::numbers::pi * u) * std::sin(2.0 * std::numbers::pi * v);
      heights[r][c] = 1.008 + 0.05 * wave + 1e-12 * state;
    }
  }
  return plate(heights, step);
}

/// A body that fills the field, 20 mm high.
inline PartMesh race_block() { return box({0.0, 0.0, 0.0}, {19.2, 12.0, 20.0}); }

}  // namespace mezzotint::benchmark
