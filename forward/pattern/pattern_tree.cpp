#include "forward/pattern/pattern_tree.h"

#include "forward/base/random.h"

namespace mezzotint {

namespace {

std::uint64_t mixed(std::uint64_t seed, std::uint64_t with) {
  const auto words = RandomStream(seed, RandomPurpose::PatternPart).bits4(with, 1);
  return std::uint64_t{words[0]} << 32U | words[1];
}

void make_independent(Pattern& pattern, std::uint64_t place) {
  std::visit(
      [place]<typename Kind>(Kind& kind) {
        if constexpr (Random<Kind>) kind.seed = mixed(kind.seed, place);
        if constexpr (Composed<Kind>) {
          std::uint64_t number = 0;
          for (PatternPart& part : kind.parts) make_independent(part.pattern, mixed(place, ++number));
        }
      },
      pattern);
}

template <typename Kind>
PatternMap stretched_map(const Kind& kind, const Sheet& sheet) {
  return in_units(turned(sheet.place, kind.direction), kind.scale.um(), kind.scale.um() * kind.stretch);
}

}  // namespace

Pattern with_independent_parts(const Pattern& pattern) {
  Pattern result = pattern;
  if (parts_of(pattern) != nullptr) make_independent(result, 0);
  return result;
}

void seed_all(Pattern& pattern, std::uint64_t seed) {
  std::visit(
      [seed]<typename Kind>(Kind& kind) {
        if constexpr (Random<Kind>) kind.seed = seed;
        if constexpr (Composed<Kind>) {
          for (PatternPart& part : kind.parts) seed_all(part.pattern, seed);
        }
      },
      pattern);
}

Sheet sheet_below(const TurnedPattern& pattern, Sheet sheet) {
  const double x = pattern.centre.x.um(), y = pattern.centre.y.um();
  sheet.place.u0 -= x;
  sheet.place.v0 -= y;
  sheet.place = turned(sheet.place, pattern.rotation);
  sheet.place.u0 += x;
  sheet.place.v0 += y;
  return sheet;
}

PatternMap map_of(const Noise& noise, const Sheet& sheet) { return stretched_map(noise, sheet); }
PatternMap map_of(const FractionalBrownianMotion& motion, const Sheet& sheet) { return stretched_map(motion, sheet); }
PatternMap map_of(const Turbulence& turbulence, const Sheet& sheet) { return stretched_map(turbulence, sheet); }
PatternMap map_of(const LineIntegralConvolution& lines, const Sheet& sheet) {
  return in_units(turned(sheet.place, lines.direction), lines.scale.um(), lines.scale.um());
}
PatternMap map_of(const Sinusoid& sinusoid, const Sheet& sheet) {
  return in_units(turned(sheet.place, sinusoid.direction), sinusoid.wavelength_u.um(), sinusoid.wavelength_v.um());
}
PatternMap map_of(const Ridges& ridges, const Sheet& sheet) {
  return in_units(turned(sheet.place, ridges.direction), ridges.wavelength.um(), ridges.wavelength.um());
}
PatternMap map_of(const PatternRegions& regions, const Sheet& sheet) {
  PatternMap map = sheet.place;
  map.u0 -= regions.corner.x.um();
  map.v0 -= regions.corner.y.um();
  return in_units(map, regions.pixel.um() * static_cast<double>(regions.columns),
                  regions.pixel.um() * static_cast<double>(regions.rows));
}

}  // namespace mezzotint
