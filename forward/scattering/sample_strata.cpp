#include "forward/scattering/sample_strata.h"

#include <cmath>

namespace mezzotint {

namespace {

// The bits 0, 2, 4, … of a number, moved together.
std::uint64_t even_bits(std::uint64_t x) {
  x &= 0x5555555555555555ULL;
  x = (x | (x >> 1)) & 0x3333333333333333ULL;
  x = (x | (x >> 2)) & 0x0f0f0f0f0f0f0f0fULL;
  x = (x | (x >> 4)) & 0x00ff00ff00ff00ffULL;
  x = (x | (x >> 8)) & 0x0000ffff0000ffffULL;
  return (x | (x >> 16)) & 0x00000000ffffffffULL;
}

}  // namespace

SampleStrata::SampleStrata(std::uint32_t bits)
    : width_(std::ldexp(1.0, -static_cast<int>((bits + 1) / 2))),
      height_(std::ldexp(1.0, -static_cast<int>(bits / 2))) {}

std::pair<double, double> SampleStrata::point(std::uint64_t index, double jitter_u, double jitter_v) const {
  return {(static_cast<double>(even_bits(index)) + jitter_u) * width_,
          (static_cast<double>(even_bits(index >> 1)) + jitter_v) * height_};
}

}  // namespace mezzotint
