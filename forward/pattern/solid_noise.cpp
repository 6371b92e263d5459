#include "forward/pattern/solid_noise.h"

// One translation unit, compiled once for each instruction set; the best that the machine has is taken at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "forward/pattern/solid_noise.cpp"  // NOLINT
#include <hwy/foreach_target.h>                               // IWYU pragma: keep
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace mezzotint::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Σ weight · (1 − 4 r²)³ over the impulses of the cells around a point.
float sum_of_impulses(const SolidCorner* corners) {
  const hn::CappedTag<float, 16> floats;
  const auto one = hn::Set(floats, 1.0F), four = hn::Set(floats, 4.0F);
  auto sum = hn::Zero(floats);
  for (int i = 0; i < 8; ++i) {
    const SolidCell& cell = *corners[i].cell;
    const auto px = hn::Set(floats, corners[i].x), py = hn::Set(floats, corners[i].y);
    const auto pz = hn::Set(floats, corners[i].z);
    for (std::size_t j = 0; j < CellImpulses::room; j += hn::Lanes(floats)) {
      const auto dx = hn::Sub(hn::Load(floats, &cell.at_x[j]), px), dy = hn::Sub(hn::Load(floats, &cell.at_y[j]), py);
      const auto dz = hn::Sub(hn::Load(floats, &cell.at_z[j]), pz);
      const auto square = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
      const auto falloff = hn::Max(hn::Zero(floats), hn::Sub(one, hn::Mul(four, square)));
      const auto cube = hn::Mul(hn::Mul(falloff, falloff), falloff);
      sum = hn::Add(sum, hn::Mul(hn::Load(floats, &cell.weight[j]), cube));
    }
  }
  return hn::GetLane(hn::SumOfLanes(floats, sum));
}

}  // namespace mezzotint::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace mezzotint {

HWY_EXPORT(sum_of_impulses);

namespace {

constexpr std::size_t kept_cells = 2048;  // a power of two

std::int64_t floor_cell(double coordinate) { return static_cast<std::int64_t>(std::floor(coordinate)); }

// The lowest bit of each coordinate, then a mixture of all.
std::size_t slot_of(std::int64_t x, std::int64_t y, std::int64_t z) {
  const auto mixed = static_cast<std::size_t>((x >> 1) * 73856093 ^ (y >> 1) * 19349663 ^ (z >> 1) * 83492791);
  return (mixed << 3U & (kept_cells - 1)) | static_cast<std::size_t>((x & 1) | (y & 1) << 1 | (z & 1) << 2);
}

}  // namespace

SolidNoise::SolidNoise(std::uint64_t seed, CellHash hash) : lattice_(seed, hash), cells_(kept_cells) {}

const SolidCell& SolidNoise::cell(std::int64_t x, std::int64_t y, std::int64_t z) {
  SolidCell& kept = cells_[slot_of(x, y, z)];
  if (kept.filled && kept.x == x && kept.y == y && kept.z == z) return kept;
  CellImpulses drawn;
  lattice_.impulses(x, y, z, drawn);
  kept.x = x;
  kept.y = y;
  kept.z = z;
  kept.filled = true;
  for (std::size_t j = 0; j < CellImpulses::room; ++j) {
    const bool is_one = j < CellImpulses::count;
    kept.at_x[j] = static_cast<float>(is_one ? drawn.x[j] : 0.0);
    kept.at_y[j] = static_cast<float>(is_one ? drawn.y[j] : 0.0);
    kept.at_z[j] = static_cast<float>(is_one ? drawn.z[j] : 0.0);
    kept.weight[j] = static_cast<float>(is_one ? drawn.weight[j] : 0.0);
  }
  return kept;
}

double SolidNoise::operator()(double x, double y, double z) {
  const std::int64_t column = floor_cell(x - 0.5), row = floor_cell(y - 0.5), layer = floor_cell(z - 0.5);
  const auto within = [](double p, std::int64_t at) { return static_cast<float>(p - static_cast<double>(at)); };
  std::array<SolidCorner, 8> corners;
  for (std::size_t i = 0; i < 8; ++i) {
    const auto n = static_cast<std::int64_t>(i);
    const std::int64_t cx = column + (n & 1), cy = row + (n >> 1 & 1), cz = layer + (n >> 2);
    // Neighbouring cells have slots of their own, so that none drives out another of the eight.
    corners[i] = {&cell(cx, cy, cz), within(x, cx), within(y, cy), within(z, cz)};
  }
  return noise_normalisation() * static_cast<double>(HWY_DYNAMIC_DISPATCH(sum_of_impulses)(corners.data()));
}

SolidPattern::SolidPattern(const OctaveSum& octaves, Length scale, CellHash hash)
    : sum_(octaves), per_um_(1.0 / scale.um()) {
  for (const Octave& octave : sum_.octaves) noises_.emplace_back(octave.seed, hash);
}
SolidPattern::SolidPattern(const Noise& noise) : SolidPattern(octave_sum(noise), noise.scale, noise.hash) {}
SolidPattern::SolidPattern(const FractionalBrownianMotion& motion)
    : SolidPattern(octave_sum(motion), motion.scale, motion.hash) {}
SolidPattern::SolidPattern(const Turbulence& turbulence)
    : SolidPattern(octave_sum(turbulence), turbulence.scale, turbulence.hash) {}

double SolidPattern::gray(double x_um, double y_um, double z_um) {
  double gray = sum_.offset;
  for (std::size_t i = 0; i < noises_.size(); ++i) {
    const double unit = per_um_ * sum_.octaves[i].frequency;
    const double value = noises_[i](x_um * unit, y_um * unit, z_um * unit);
    gray += sum_.octaves[i].weight * (sum_.absolute ? std::abs(value) : value);
  }
  return std::clamp(gray, 0.0, 1.0);
}

}  // namespace mezzotint

#endif
