#include "tests/benchmark/measured_scan.h"

#include <cmath>
#include <limits>

#include "forward/base/random.h"
#include "tests/benchmark/noise_relief.h"

namespace mezzotint::benchmark {

namespace {

constexpr float missing = std::numeric_limits<float>::quiet_NaN();

double rms_um(const HeightField& field) {
  double squares = 0.0;
  for (const float z : field.heights_um()) squares += static_cast<double>(z) * z;
  return std::sqrt(squares / static_cast<double>(field.grid().size()));
}

}  // namespace

HeightField measured_scan(std::size_t size) {
  const HeightField relief = noise_relief(size, 0.3);
  const double scale = 2.0 / rms_um(relief);
  HeightField scan(relief.grid(), Continuation::Mirrored);
  const RandomStream random(1, RandomPurpose::Test);
  for (std::size_t row = 0; row < size; ++row)
    for (std::size_t column = 0; column < size; ++column) {
      const double x = 2.0 * static_cast<double>(column) / static_cast<double>(size - 1) - 1.0;
      const double y = 2.0 * static_cast<double>(row) / static_cast<double>(size - 1) - 1.0;
      const auto u = random.uniform4(row * size + column, 0);
      const double spike = u[0] < 0.003 ? (u[1] < 0.5 ? -1.0 : 1.0) * (20.0 + 40.0 * u[2]) : 0.0;
      const double base = 3.0 * x - 1.5 * y + 1.0 * x * x - 0.7 * x * y * y;
      scan.at(column, row) = static_cast<float>(scale * static_cast<double>(relief.at(column, row)) + base + spike);
    }
  return scan;
}

HeightField scan_with_holes(std::size_t size) {
  HeightField scan = measured_scan(size);
  const RandomStream random(2, RandomPurpose::Test);
  const double middle_x = 0.4 * static_cast<double>(size), middle_y = 0.6 * static_cast<double>(size);
  const double radius = static_cast<double>(size) / 16.0;
  for (std::size_t row = 0; row < size; ++row)
    for (std::size_t column = 0; column < size; ++column) {
      const auto u = random.uniform4((row / 2) * size + column / 2, 0);
      const bool lost = u[0] < 0.01;
      const bool in_hole =
          std::hypot(static_cast<double>(column) - middle_x, static_cast<double>(row) - middle_y) < radius;
      if (lost || in_hole) scan.at(column, row) = missing;
    }
  return scan;
}

}  // namespace mezzotint::benchmark
