#include "tests/benchmark/noise_relief.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "forward/base/random.h"
#include "forward/surface/slope_covariance.h"

namespace mezzotint::benchmark {

namespace {

constexpr double radius = 0.5;  // of an impulse, in lattice cells
constexpr int impulses_per_cell = 30;

// Adds amplitude · (1 − 4r²)³ around a place in lattice cells; the tile goes on periodically.
void add_impulse(HeightField& field, double pixels, double x, double y, double z, double amplitude) {
  const auto size = static_cast<std::int64_t>(field.columns());
  const double reach = std::sqrt(std::max(0.0, radius * radius - z * z)) * pixels;
  const double at_x = x * pixels, at_y = y * pixels;
  for (auto row = static_cast<std::int64_t>(std::ceil(at_y - reach)); static_cast<double>(row) < at_y + reach; ++row) {
    const auto line = static_cast<std::size_t>((row % size + size) % size);
    const double v = (static_cast<double>(row) - at_y) / pixels;
    for (auto column = static_cast<std::int64_t>(std::ceil(at_x - reach)); static_cast<double>(column) < at_x + reach;
         ++column) {
      const double u = (static_cast<double>(column) - at_x) / pixels;
      const double inside = std::max(0.0, 1.0 - 4.0 * (u * u + v * v + z * z));
      field.at(static_cast<std::size_t>((column % size + size) % size), line) +=
          static_cast<float>(amplitude * inside * inside * inside);
    }
  }
}

void add_octave(HeightField& field, std::uint64_t lattice, double amplitude) {
  const RandomStream random(lattice, RandomPurpose::Test);
  const double pixels = static_cast<double>(field.columns()) / static_cast<double>(lattice);
  for (std::uint64_t cell = 0; cell < lattice * lattice; ++cell) {
    const auto column = static_cast<double>(cell % lattice), row = static_cast<double>(cell / lattice);
    // Two layers of cells, above and below the plane that is looked at.
    for (std::uint32_t k = 0; k < 2 * impulses_per_cell; ++k) {
      const auto u = random.uniform4(cell, k);
      const double z = k < impulses_per_cell ? u[2] : u[2] - 1.0;
      const double sign = k % 2 == 0 ? 1.0 : -1.0;
      if (std::abs(z) < radius) add_impulse(field, pixels, column + u[0], row + u[1], z, amplitude * sign * u[3]);
    }
  }
}

}  // namespace

HeightField noise_relief(std::size_t size, double gradient) {
  const Length pitch = Length::from_um(1.0);
  HeightField field({size, size, pitch, pitch}, Continuation::Periodic);
  add_octave(field, 16, 1.0);
  add_octave(field, 32, 0.5);
  add_octave(field, 64, 0.25);
  const SlopeCovariance slopes = slope_covariance(field);
  const double scale = gradient / std::sqrt(slopes.xx + slopes.yy);
  for (float& z : field.heights_um()) z = static_cast<float>(z * scale);
  return field;
}

}  // namespace mezzotint::benchmark
