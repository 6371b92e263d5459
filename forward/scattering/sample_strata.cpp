#include "forward/scattering/sample_strata.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "forward/base/random.h"

namespace mezzotint {

namespace {

// The bits 0, 2, 4, … of a number, moved together.
constexpr std::uint64_t even_bits(std::uint64_t x) {
  x &= 0x5555555555555555ULL;
  x = (x | (x >> 1)) & 0x3333333333333333ULL;
  x = (x | (x >> 2)) & 0x0f0f0f0f0f0f0f0fULL;
  x = (x | (x >> 4)) & 0x00ff00ff00ff00ffULL;
  x = (x | (x >> 8)) & 0x0000ffff0000ffffULL;
  return (x | (x >> 16)) & 0x00000000ffffffffULL;
}

// The curve is followed in blocks of 8 × 8 strata, whose inner order is a table.
constexpr std::size_t block = 64;
struct BlockOrder {
  std::array<double, block> u{}, v{};
};
constexpr BlockOrder make_order() {
  BlockOrder order;
  for (std::size_t k = 0; k < block; ++k) {
    order.u[k] = static_cast<double>(even_bits(k));
    order.v[k] = static_cast<double>(even_bits(k >> 1));
  }
  return order;
}
constexpr BlockOrder order_in_block = make_order();

constexpr std::uint32_t hash(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352dU;
  x ^= x >> 15;
  x *= 0x846ca68bU;
  return x ^ (x >> 16);
}

constexpr double unit = 0x1p-32;

}  // namespace

SampleStrata::SampleStrata(std::uint32_t bits, Placement placement, std::uint64_t seed, std::uint32_t pass,
                           std::uint32_t batch)
    : placement_(placement),
      width_(std::ldexp(1.0, -static_cast<int>((bits + 1) / 2))),
      height_(std::ldexp(1.0, -static_cast<int>(bits / 2))) {
  const auto keys = RandomStream(seed, RandomPurpose::RayPosition).bits4(batch, pass);
  key_u_ = keys[0];
  key_v_ = keys[1];
  shift_u_ = keys[2] * unit;
  shift_v_ = keys[3] * unit;
}

void SampleStrata::points(std::uint64_t first, std::span<double> u, std::span<double> v) const {
  for (std::size_t done = 0; done < u.size();) {
    const std::uint64_t index = first + done;
    const std::size_t count = std::min<std::size_t>(u.size() - done, block - index % block);
    fill_block(index, u.subspan(done, count), v.subspan(done, count));
    done += count;
  }
}

void SampleStrata::points_on_line(std::uint64_t first, std::span<double> u, std::span<double> v) const {
  const double width = width_ * height_;
  for (std::size_t k = 0; k < u.size(); ++k) {
    const std::uint64_t index = first + k;
    const std::uint32_t key_u = key_u_ + static_cast<std::uint32_t>(index >> 32) * 0x9e3779b9U;
    const std::uint32_t a = hash(static_cast<std::uint32_t>(index) ^ key_u), b = hash(a ^ key_v_);
    const double jitter = placement_ == Placement::Lattice ? shift_u_ : a * unit;
    u[k] = placement_ == Placement::Random ? jitter : (static_cast<double>(index) + jitter) * width;
    v[k] = b * unit;
  }
}

void SampleStrata::fill_block(std::uint64_t first, std::span<double> u, std::span<double> v) const {
  const std::uint64_t base = first / block;
  const auto base_u = static_cast<double>(even_bits(base) * 8), base_v = static_cast<double>(even_bits(base >> 1) * 8);
  const auto number = static_cast<std::uint32_t>(first);
  // The upper half of the number enters by the keys, so that 2^32 strata and more do not repeat.
  const std::uint32_t key_u = key_u_ + static_cast<std::uint32_t>(first >> 32) * 0x9e3779b9U;
  const std::size_t inner = first % block;
  for (std::size_t k = 0; k < u.size(); ++k) {
    const std::uint32_t a = hash((number + static_cast<std::uint32_t>(k)) ^ key_u);
    const std::uint32_t b = hash(a ^ key_v_);
    const double jitter_u = placement_ == Placement::Lattice ? shift_u_ : a * unit;
    const double jitter_v = placement_ == Placement::Lattice ? shift_v_ : b * unit;
    const bool strata = placement_ != Placement::Random;
    u[k] = strata ? (base_u + order_in_block.u[inner + k] + jitter_u) * width_ : jitter_u;
    v[k] = strata ? (base_v + order_in_block.v[inner + k] + jitter_v) * height_ : jitter_v;
  }
}

}  // namespace mezzotint
