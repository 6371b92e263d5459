#include "forward/pattern/solid_noise.h"

// One translation unit, compiled once for each instruction set; the best that the machine has is taken at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "forward/pattern/solid_noise.cpp"  // NOLINT
#include <hwy/foreach_target.h>                               // IWYU pragma: keep
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

#include "forward/pattern/line_integral_convolution.h"

HWY_BEFORE_NAMESPACE();
namespace mezzotint::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Σ weight · (1 − 4 r²)³ over the impulses of some cells.
float sum_of_impulses(const SolidCorner* corners, std::size_t count) {
  const hn::CappedTag<float, 16> floats;
  const auto one = hn::Set(floats, 1.0F), four = hn::Set(floats, 4.0F);
  auto sum = hn::Zero(floats);
  for (std::size_t i = 0; i < count; ++i) {
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

// The same where r is shorter along a unit vector: r² = d² − shrink·(d·along)².
float sum_of_long_impulses(const SolidCorner* corners, std::size_t count, const float* along, float shrink) {
  const hn::CappedTag<float, 16> floats;
  const auto one = hn::Set(floats, 1.0F), four = hn::Set(floats, 4.0F), less = hn::Set(floats, shrink);
  const auto ax = hn::Set(floats, along[0]), ay = hn::Set(floats, along[1]), az = hn::Set(floats, along[2]);
  auto sum = hn::Zero(floats);
  for (std::size_t i = 0; i < count; ++i) {
    const SolidCell& cell = *corners[i].cell;
    const auto px = hn::Set(floats, corners[i].x), py = hn::Set(floats, corners[i].y);
    const auto pz = hn::Set(floats, corners[i].z);
    for (std::size_t j = 0; j < CellImpulses::room; j += hn::Lanes(floats)) {
      const auto dx = hn::Sub(hn::Load(floats, &cell.at_x[j]), px), dy = hn::Sub(hn::Load(floats, &cell.at_y[j]), py);
      const auto dz = hn::Sub(hn::Load(floats, &cell.at_z[j]), pz);
      const auto square = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
      const auto part = hn::Add(hn::Add(hn::Mul(dx, ax), hn::Mul(dy, ay)), hn::Mul(dz, az));
      const auto near = hn::Sub(square, hn::Mul(less, hn::Mul(part, part)));
      const auto falloff = hn::Max(hn::Zero(floats), hn::Sub(one, hn::Mul(four, near)));
      const auto cube = hn::Mul(hn::Mul(falloff, falloff), falloff);
      sum = hn::Add(sum, hn::Mul(hn::Load(floats, &cell.weight[j]), cube));
    }
  }
  return hn::GetLane(hn::SumOfLanes(floats, sum));
}

// ∫(A − 4u²)³ du from 0.
template <class V>
V integral(V a, V u) {
  const hn::CappedTag<float, 16> floats;
  const auto w = hn::Mul(u, u);
  const auto inner = hn::Sub(hn::Mul(hn::Set(floats, 9.6F), a), hn::Mul(hn::Set(floats, 64.0F / 7.0F), w));
  const auto outer = hn::Sub(hn::Mul(w, inner), hn::Mul(hn::Set(floats, 4.0F), hn::Mul(a, a)));
  return hn::Mul(u, hn::Add(hn::Mul(a, hn::Mul(a, a)), hn::Mul(w, outer)));
}

// Σ weight · ∫(1 − 4 r²)³ along a line of that half length about a point: r² = ρ² + u², ρ the impulse's distance from
// the line and u the way from its foot.
float sum_of_smeared_impulses(const SolidCorner* corners, std::size_t count, const float* along, float half) {
  const hn::CappedTag<float, 16> floats;
  const auto one = hn::Set(floats, 1.0F), four = hn::Set(floats, 4.0F), end = hn::Set(floats, half);
  const auto ax = hn::Set(floats, along[0]), ay = hn::Set(floats, along[1]), az = hn::Set(floats, along[2]);
  auto sum = hn::Zero(floats);
  for (std::size_t i = 0; i < count; ++i) {
    const SolidCell& cell = *corners[i].cell;
    const auto px = hn::Set(floats, corners[i].x), py = hn::Set(floats, corners[i].y);
    const auto pz = hn::Set(floats, corners[i].z);
    for (std::size_t j = 0; j < CellImpulses::room; j += hn::Lanes(floats)) {
      const auto dx = hn::Sub(hn::Load(floats, &cell.at_x[j]), px), dy = hn::Sub(hn::Load(floats, &cell.at_y[j]), py);
      const auto dz = hn::Sub(hn::Load(floats, &cell.at_z[j]), pz);
      const auto square = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
      const auto foot = hn::Add(hn::Add(hn::Mul(dx, ax), hn::Mul(dy, ay)), hn::Mul(dz, az));
      const auto a = hn::Max(hn::Zero(floats), hn::Sub(one, hn::Mul(four, hn::Sub(square, hn::Mul(foot, foot)))));
      const auto reach = hn::Mul(hn::Set(floats, 0.5F), hn::Sqrt(a));
      const auto low = hn::Max(hn::Neg(reach), hn::Sub(hn::Neg(end), foot));
      const auto high = hn::Max(low, hn::Min(reach, hn::Sub(end, foot)));
      const auto part = hn::Sub(integral(a, high), integral(a, low));
      sum = hn::Add(sum, hn::Mul(hn::Load(floats, &cell.weight[j]), part));
    }
  }
  return hn::GetLane(hn::SumOfLanes(floats, sum));
}

}  // namespace mezzotint::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace mezzotint {

HWY_EXPORT(sum_of_impulses);
HWY_EXPORT(sum_of_long_impulses);
HWY_EXPORT(sum_of_smeared_impulses);

namespace {

constexpr std::size_t kept_cells = 2048;  // a power of two

std::int64_t floor_cell(double coordinate) { return static_cast<std::int64_t>(std::floor(coordinate)); }

// The lowest bit of each coordinate, then a mixture of all.
std::size_t slot_of(std::int64_t x, std::int64_t y, std::int64_t z) {
  const auto mixed = static_cast<std::size_t>((x >> 1) * 73856093 ^ (y >> 1) * 19349663 ^ (z >> 1) * 83492791);
  return (mixed << 3U & (kept_cells - 1)) | static_cast<std::size_t>((x & 1) | (y & 1) << 1 | (z & 1) << 2);
}

std::array<float, 3> floats_of(const std::array<double, 3>& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

// Whether anything of a cell can be within ½ of a line of that half length about a point.
bool near_line(const std::array<std::int64_t, 3>& cell, const std::array<double, 3>& at,
               const std::array<double, 3>& along, double half) {
  constexpr double reach = 0.5 + 0.8660254037844386;  // to the corner of a cell
  std::array<double, 3> way{};
  double part = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    way[i] = static_cast<double>(cell[i]) + 0.5 - at[i];
    part += way[i] * along[i];
  }
  part = std::clamp(part, -half, half);
  double square = 0.0;
  for (std::size_t i = 0; i < 3; ++i) square += (way[i] - part * along[i]) * (way[i] - part * along[i]);
  return square <= reach * reach;
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
  return noise_normalisation() *
         static_cast<double>(HWY_DYNAMIC_DISPATCH(sum_of_impulses)(corners.data(), corners.size()));
}

template <class Sum>
double SolidNoise::sum_near_line(const Line& line, const Sum& sum_of) {
  std::array<std::int64_t, 3> low{}, high{};
  for (std::size_t i = 0; i < 3; ++i) {
    low[i] = floor_cell(line.at[i] - line.reach[i]);
    high[i] = floor_cell(line.at[i] + line.reach[i]);
  }
  const auto within = [](double p, std::int64_t from) { return static_cast<float>(p - static_cast<double>(from)); };
  double sum = 0.0;
  for (std::int64_t z = low[2]; z <= high[2]; ++z) {
    for (std::int64_t y = low[1]; y <= high[1]; ++y) {
      for (std::int64_t x = low[0]; x <= high[0]; ++x) {
        if (!near_line({x, y, z}, line.at, line.along, line.half)) continue;
        // One at a time: the next cell may take this one's slot.
        const SolidCorner corner{&cell(x, y, z), within(line.at[0], x), within(line.at[1], y), within(line.at[2], z)};
        sum += static_cast<double>(sum_of(corner));
      }
    }
  }
  return noise_normalisation() * sum;
}

double SolidNoise::stretched(const std::array<double, 3>& at, const std::array<double, 3>& along, double stretch) {
  Line line{at, along, {}, 0.5 * stretch};
  for (std::size_t i = 0; i < 3; ++i)
    line.reach[i] = 0.5 * std::sqrt(1.0 + (stretch * stretch - 1.0) * along[i] * along[i]);
  const auto shrink = static_cast<float>(1.0 - 1.0 / (stretch * stretch));
  const std::array<float, 3> axis = floats_of(along);
  const double sum = sum_near_line(line, [&](const SolidCorner& corner) {
    return HWY_DYNAMIC_DISPATCH(sum_of_long_impulses)(&corner, 1, axis.data(), shrink);
  });
  // As many more impulses reach a point as they are longer.
  return sum / std::sqrt(stretch);
}

double SolidNoise::smeared(const std::array<double, 3>& at, const std::array<double, 3>& along, double length) {
  if (length != length_) {
    length_ = length;
    amplitude_ = smeared_noise(length).amplitude;
  }
  Line line{at, along, {}, 0.5 * length};
  for (std::size_t i = 0; i < 3; ++i) line.reach[i] = 0.5 * length * std::abs(along[i]) + 0.5;
  const std::array<float, 3> axis = floats_of(along);
  const auto half = static_cast<float>(line.half);
  const double sum = sum_near_line(line, [&](const SolidCorner& corner) {
    return HWY_DYNAMIC_DISPATCH(sum_of_smeared_impulses)(&corner, 1, axis.data(), half);
  });
  return amplitude_ * sum / length;
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

template <class Value>
double SolidPattern::sum_of(const Value& value) {
  double gray = sum_.offset;
  for (std::size_t i = 0; i < noises_.size(); ++i) {
    const double one = value(noises_[i], per_um_ * sum_.octaves[i].frequency);
    gray += sum_.octaves[i].weight * (sum_.absolute ? std::abs(one) : one);
  }
  return std::clamp(gray, 0.0, 1.0);
}

double SolidPattern::gray(double x_um, double y_um, double z_um) {
  return sum_of([&](SolidNoise& noise, double unit) { return noise(x_um * unit, y_um * unit, z_um * unit); });
}

double SolidPattern::gray_along(const std::array<double, 3>& at_um, const std::array<double, 3>& along,
                                double stretch) {
  return sum_of([&](SolidNoise& noise, double unit) {
    return noise.stretched({at_um[0] * unit, at_um[1] * unit, at_um[2] * unit}, along, stretch);
  });
}

}  // namespace mezzotint

#endif
