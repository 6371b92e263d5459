#include "forward/pattern/sparse_noise.h"

#include <algorithm>
#include <cmath>

namespace mezzotint {

namespace {

std::int64_t floor_cell(double coordinate) { return static_cast<std::int64_t>(std::floor(coordinate)); }

}  // namespace

double sparse_noise(const NoiseLattice& lattice, double x, double y, double z) {
  CellImpulses at;
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const std::int64_t column = floor_cell(x - 0.5) + (corner & 1), row = floor_cell(y - 0.5) + (corner >> 1 & 1);
    const std::int64_t layer = floor_cell(z - 0.5) + (corner >> 2);
    lattice.impulses(column, row, layer, at);
    const double px = x - static_cast<double>(column), py = y - static_cast<double>(row);
    const double pz = z - static_cast<double>(layer);
    for (std::size_t j = 0; j < CellImpulses::count; ++j) {
      const double dx = at.x[j] - px, dy = at.y[j] - py, dz = at.z[j] - pz;
      const double falloff = std::max(0.0, 1.0 - 4.0 * (dx * dx + dy * dy + dz * dz));
      sum += at.weight[j] * falloff * falloff * falloff;
    }
  }
  return noise_normalisation() * sum;
}

double sparse_noise(double x, double y, double z, std::uint64_t seed, CellHash hash) {
  return sparse_noise(NoiseLattice(seed, hash), x, y, z);
}

}  // namespace mezzotint
