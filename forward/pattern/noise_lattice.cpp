#include "forward/pattern/noise_lattice.h"

#include <cmath>
#include <cstdlib>
#include <utility>

namespace mezzotint {

namespace {

std::uint64_t cell_index(std::int64_t x, std::int64_t y, std::int64_t z, CellHash hash) {
  if (hash == CellHash::Slides) return static_cast<std::uint64_t>(x + 1000 * y + 576 * z);
  const auto packed = [](std::int64_t value) { return static_cast<std::uint64_t>(value) & 0x1FFFFFU; };
  return packed(x) | packed(y) << 21U | packed(z) << 42U;
}

std::int64_t floored_quotient(std::int64_t a, std::int64_t b) {
  const std::int64_t quotient = a / b;
  return a % b != 0 && (a < 0) != (b < 0) ? quotient - 1 : quotient;
}

}  // namespace

double noise_normalisation() { return 4.0 / (5.0 * std::cbrt(static_cast<double>(CellImpulses::count))); }

NoiseLattice::NoiseLattice(std::uint64_t seed, CellHash hash, const PatternMap& map, const Sheet& sheet)
    : seed_(seed), hash_(hash) {
  if (sheet.continuation != Continuation::Periodic) return;
  // The tile's sides in cells, brought to the Hermite normal form of the lattice that they span, by Euclid's steps.
  std::array<std::int64_t, 2> a = {std::llround(map.ux * sheet.width_um()), std::llround(map.vx * sheet.width_um())};
  std::array<std::int64_t, 2> b = {std::llround(map.uy * sheet.depth_um()), std::llround(map.vy * sheet.depth_um())};
  while (a[1] != 0) {
    const std::int64_t times = b[1] / a[1];
    b = {b[0] - times * a[0], b[1] - times * a[1]};
    std::swap(a, b);
  }
  step_x_ = std::abs(a[0]);
  step_y_ = std::abs(b[1]);
  shear_ = b[1] < 0 ? -b[0] : b[0];
}

void NoiseLattice::impulses(std::int64_t x, std::int64_t y, std::int64_t z, CellImpulses& into) const {
  if (step_y_ != 0) {
    const std::int64_t times = floored_quotient(y, step_y_);
    y -= times * step_y_;
    x -= times * shear_;
    x -= floored_quotient(x, step_x_) * step_x_;
  }
  draw_impulses(seed_, cell_index(x, y, z, hash_), into);
}

}  // namespace mezzotint
