#include "forward/pattern/sparse_noise.h"

#include <algorithm>
#include <cmath>

namespace mezzotint {

namespace {

std::int64_t floor_cell(double coordinate) { return static_cast<std::int64_t>(std::floor(coordinate)); }

// Calls visit(weight, falloff, dx, dy) for the impulses that reach a point.
template <typename Visit>
void for_each_impulse(const NoiseLattice& lattice, double x, double y, double z, const Visit& visit) {
  CellImpulses at;
  for (int corner = 0; corner < 8; ++corner) {
    const std::int64_t column = floor_cell(x - 0.5) + (corner & 1), row = floor_cell(y - 0.5) + (corner >> 1 & 1);
    const std::int64_t layer = floor_cell(z - 0.5) + (corner >> 2);
    lattice.impulses(column, row, layer, at);
    const double px = x - static_cast<double>(column), py = y - static_cast<double>(row);
    const double pz = z - static_cast<double>(layer);
    for (std::size_t j = 0; j < CellImpulses::count; ++j) {
      const double dx = at.x[j] - px, dy = at.y[j] - py, dz = at.z[j] - pz;
      visit(at.weight[j], std::max(0.0, 1.0 - 4.0 * (dx * dx + dy * dy + dz * dz)), dx, dy);
    }
  }
}

}  // namespace

double sparse_noise(const NoiseLattice& lattice, double x, double y, double z) {
  double sum = 0.0;
  for_each_impulse(lattice, x, y, z, [&sum](double weight, double falloff, double, double) {
    sum += weight * falloff * falloff * falloff;
  });
  return noise_normalisation() * sum;
}

std::array<double, 2> sparse_noise_gradient(const NoiseLattice& lattice, double x, double y, double z) {
  std::array<double, 2> sum{};
  for_each_impulse(lattice, x, y, z, [&sum](double weight, double falloff, double dx, double dy) {
    const double slope = 24.0 * weight * falloff * falloff;
    sum[0] += slope * dx;
    sum[1] += slope * dy;
  });
  return {noise_normalisation() * sum[0], noise_normalisation() * sum[1]};
}

double sparse_noise(double x, double y, double z, std::uint64_t seed, CellHash hash) {
  return sparse_noise(NoiseLattice(seed, hash), x, y, z);
}

}  // namespace mezzotint
