#pragma once

#include "forward/pattern/pattern.h"
#include "forward/pattern/pattern_map.h"

/// Inside of forward/pattern.

namespace mezzotint {

template <typename Kind>
concept Random = requires(Kind kind) {
  kind.seed;
};

template <typename Kind>
concept Composed = requires(Kind kind) {
  kind.parts;
};

/// The pattern with seeds by which its parts are independent of one another.
[[nodiscard]] Pattern with_independent_parts(const Pattern& pattern);

/// All random parts get that seed, all periodic ones phases that follow from it and from their places.
void draw_all(Pattern& pattern, std::uint64_t seed);

/// Where the part of a turned pattern lies.
[[nodiscard]] Sheet sheet_below(const TurnedPattern& turned, Sheet sheet);
template <typename Kind>
[[nodiscard]] Sheet sheet_below(const Kind&, const Sheet& sheet) {
  return sheet;
}

/// The units of a kind's u and v in µm, for its coarsest octave.
struct Units {
  double u, v;
};
[[nodiscard]] Units units_of(const Noise& noise);
[[nodiscard]] Units units_of(const FractionalBrownianMotion& motion);
[[nodiscard]] Units units_of(const Turbulence& turbulence);
[[nodiscard]] Units units_of(const LineIntegralConvolution& lines);
[[nodiscard]] Units units_of(const Sinusoid& sinusoid);
[[nodiscard]] Units units_of(const Ridges& ridges);

/// The map from the plane's µm to a kind's own units, for its coarsest octave and before it is fitted to a tile. Linear
/// in `place`.
template <typename Kind>
[[nodiscard]] PatternMap map_without_phase(const Kind& kind, const PatternMap& place) {
  const Units units = units_of(kind);
  return in_units(turned(place, kind.direction), units.u, units.v);
}
template <typename Kind>
[[nodiscard]] PatternMap map_of(const Kind& kind, const Sheet& sheet) requires requires {
  units_of(kind);
}
{ return map_without_phase(kind, sheet.place); }
[[nodiscard]] PatternMap map_of(const Sinusoid& sinusoid, const Sheet& sheet);
[[nodiscard]] PatternMap map_of(const Ridges& ridges, const Sheet& sheet);
/// In pictures, which repeat.
[[nodiscard]] PatternMap map_of(const PatternRegions& regions, const Sheet& sheet);

}  // namespace mezzotint
