#include "forward/base/random.h"

#include <Random123/philox.h>

#include <cmath>
#include <numbers>

namespace mezzotint {

std::array<std::uint32_t, 4> RandomStream::bits4(std::uint64_t index, std::uint32_t draw) const {
  using Philox = r123::Philox4x32;
  const Philox::ctr_type counter = {{static_cast<std::uint32_t>(index), static_cast<std::uint32_t>(index >> 32), draw,
                                     static_cast<std::uint32_t>(purpose_)}};
  const Philox::key_type key = {{static_cast<std::uint32_t>(seed_), static_cast<std::uint32_t>(seed_ >> 32)}};
  const Philox::ctr_type words = Philox()(counter, key);
  return {words[0], words[1], words[2], words[3]};
}

std::array<double, 4> RandomStream::uniform4(std::uint64_t index, std::uint32_t draw) const {
  const auto words = bits4(index, draw);
  constexpr double scale = 1.0 / 4294967296.0;
  return {words[0] * scale, words[1] * scale, words[2] * scale, words[3] * scale};
}

std::array<double, 4> RandomStream::normal4(std::uint64_t index, std::uint32_t draw) const {
  const auto u = uniform4(index, draw);
  std::array<double, 4> normals{};
  for (int pair = 0; pair < 2; ++pair) {
    const double radius = std::sqrt(-2.0 * std::log1p(-u[2 * pair]));
    const double angle = 2.0 * std::numbers::pi * u[2 * pair + 1];
    normals[2 * pair] = radius * std::cos(angle);
    normals[2 * pair + 1] = radius * std::sin(angle);
  }
  return normals;
}

}  // namespace mezzotint
