#include "forward/pattern/pattern_tree.h"

#include <array>
#include <cmath>

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

// Phases of draws with consecutive seeds fill the period evenly, where random ones would leave gaps: a mean over few
// draws comes that much nearer to the mean over all. Kronecker's sequence: a step of √prime, in whole 64-bit turns.
double phase_of(std::uint64_t seed, std::uint64_t place, std::size_t axis) {
  constexpr std::array primes = {2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53};
  const double root = std::sqrt(static_cast<double>(primes[axis % primes.size()]));
  const auto step = static_cast<std::uint64_t>(std::ldexp(root - std::floor(root), 53)) << 11U;
  return std::ldexp(static_cast<double>((seed * step + mixed(axis, place)) >> 11U), -53);
}

template <typename Kind>
void set_phases(Kind&, std::uint64_t, std::uint64_t, std::size_t&) {}
void set_phases(Sinusoid& sinusoid, std::uint64_t seed, std::uint64_t place, std::size_t& axis) {
  sinusoid.phase_u = phase_of(seed, place, axis++);
  sinusoid.phase_v = phase_of(seed, place, axis++);
}
void set_phases(Ridges& ridges, std::uint64_t seed, std::uint64_t place, std::size_t& axis) {
  ridges.phase = phase_of(seed, place, axis++);
}

// `axis` counts the phases of all parts.
void draw_part(Pattern& pattern, std::uint64_t seed, std::uint64_t place, std::size_t& axis) {
  std::visit(
      [&]<typename Kind>(Kind& kind) {
        set_phases(kind, seed, place, axis);
        if constexpr (Random<Kind>) kind.seed = seed;
        if constexpr (Composed<Kind>) {
          std::uint64_t number = 0;
          for (PatternPart& part : kind.parts) draw_part(part.pattern, seed, mixed(place, ++number), axis);
        }
      },
      pattern);
}

template <typename Kind>
Units stretched(const Kind& kind) {
  return {kind.scale.um(), kind.scale.um() * kind.stretch};
}

}  // namespace

Pattern with_independent_parts(const Pattern& pattern) {
  Pattern result = pattern;
  if (parts_of(pattern) != nullptr) make_independent(result, 0);
  return result;
}

void draw_all(Pattern& pattern, std::uint64_t seed) {
  std::size_t axis = 0;
  draw_part(pattern, seed, 0, axis);
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

Units units_of(const Noise& noise) { return stretched(noise); }
Units units_of(const FractionalBrownianMotion& motion) { return stretched(motion); }
Units units_of(const Turbulence& turbulence) { return stretched(turbulence); }
Units units_of(const LineIntegralConvolution& lines) { return {lines.scale.um(), lines.scale.um()}; }
Units units_of(const Sinusoid& sinusoid) { return {sinusoid.wavelength_u.um(), sinusoid.wavelength_v.um()}; }
Units units_of(const Ridges& ridges) { return {ridges.wavelength.um(), ridges.wavelength.um()}; }

PatternMap map_of(const Sinusoid& sinusoid, const Sheet& sheet) {
  return moved(map_without_phase(sinusoid, sheet.place), sinusoid.phase_u, sinusoid.phase_v);
}
PatternMap map_of(const Ridges& ridges, const Sheet& sheet) {
  return moved(map_without_phase(ridges, sheet.place), ridges.phase, 0.0);
}
PatternMap map_of(const PatternRegions& regions, const Sheet& sheet) {
  PatternMap map = sheet.place;
  map.u0 -= regions.corner.x.um();
  map.v0 -= regions.corner.y.um();
  return in_units(map, regions.pixel.um() * static_cast<double>(regions.columns),
                  regions.pixel.um() * static_cast<double>(regions.rows));
}

}  // namespace mezzotint
