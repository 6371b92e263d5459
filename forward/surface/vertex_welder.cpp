#include "forward/surface/vertex_welder.h"

#include <algorithm>
#include <bit>

namespace mezzotint {

namespace {

constexpr std::size_t fewest_slots = 1024;

std::uint64_t hash_of(const VertexWelder::Place& place) {
  std::uint64_t hash = 0;
  for (const double coordinate : place)
    hash = (std::rotl(hash, 23) ^ std::bit_cast<std::uint64_t>(coordinate)) * 0x9E3779B97F4A7C15U;
  return hash ^ (hash >> 32U);
}

}  // namespace

VertexWelder::VertexWelder(std::size_t expected) : slots_(std::bit_ceil(std::max(fewest_slots, 2 * expected))) {
  vertices_.reserve(expected);
}

void VertexWelder::prefetch(Place place) const {
  for (double& coordinate : place) coordinate += 0.0;
  __builtin_prefetch(&slots_[hash_of(place) & (slots_.size() - 1)]);
}

VertexWelder::Number VertexWelder::number(Place place) {
  for (double& coordinate : place) coordinate += 0.0;  // −0 is 0
  const std::uint64_t wide = hash_of(place);
  const auto hash = static_cast<std::uint32_t>(wide >> 32U);
  const std::size_t mask = slots_.size() - 1;
  std::size_t at = wide & mask;
  for (; slots_[at].number_plus_one != 0; at = (at + 1) & mask) {
    if (slots_[at].hash == hash && vertices_[slots_[at].number_plus_one - 1] == place)
      return {slots_[at].number_plus_one - 1, false};
  }
  vertices_.push_back(place);
  const auto number = static_cast<std::uint32_t>(vertices_.size());
  slots_[at] = {number, hash};
  if (2 * vertices_.size() > slots_.size()) grow();
  return {number - 1, true};
}

void VertexWelder::grow() {
  slots_.assign(2 * slots_.size(), {});
  const std::size_t mask = slots_.size() - 1;
  for (std::size_t k = 0; k < vertices_.size(); ++k) {
    const std::uint64_t wide = hash_of(vertices_[k]);
    std::size_t at = wide & mask;
    while (slots_[at].number_plus_one != 0) at = (at + 1) & mask;
    slots_[at] = {static_cast<std::uint32_t>(k + 1), static_cast<std::uint32_t>(wide >> 32U)};
  }
}

}  // namespace mezzotint
