#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <utility>

#include "forward/base/error.h"
#include "measurement/reflectance/reflectance_map.h"
#include "measurement/reflectance/reflectance_parsers.h"

// Every reader of measured BRDFs as a function of bytes alone: what is fuzzed, and what the corpus is replayed through.
// What was read is also asked for values, where a bad count would lead outside of the samples.
namespace mezzotint::fuzzed {

using Bytes = std::span<const std::byte>;

inline void ask(const MeasuredReflectance& measured) {
  std::vector<DirectionAngles> lights = {{20.0_deg, 30.0_deg}};
  if (!measured.incidences.empty()) {
    lights.push_back(measured.incidences.front());
    lights.push_back(measured.incidences.back());
  }
  for (const DirectionAngles& light : lights) {
    try {
      static_cast<void>(reflectance_map(measured, light, {.name = measured.channels.back().name}, {4, 4}, 2));
    } catch (const InvalidInput&) {  // a light that was not measured
    }
  }
}

inline void rgl(Bytes bytes) { ask(parse_rgl("f", bytes)); }
inline void zemax(Bytes bytes) { ask(parse_zemax("f", bytes)); }
inline void fred(Bytes bytes) { ask(parse_fred("f", bytes)); }
inline void cornell(Bytes bytes) { ask(parse_cornell("f", bytes)); }
inline void alta(Bytes bytes) { ask(parse_alta("f", bytes)); }

inline constexpr std::pair<std::string_view, void (*)(Bytes)> reflectance_readers[] = {
    {"rgl", rgl}, {"zemax", zemax}, {"fred", fred}, {"cornell", cornell}, {"alta", alta}};

}  // namespace mezzotint::fuzzed
