#include "forward/pattern/pattern_waves.h"

#include <algorithm>
#include <cmath>

#include "forward/pattern/pattern_tree.h"

namespace mezzotint {

namespace {

struct Wave {
  double x, y;  ///< along its wave vector
};

// The waves of what is periodic in a pattern, and of its square.
struct Periodicity {
  std::vector<Wave> waves;
  bool unknown = false;  ///< several periodic patterns in one

  [[nodiscard]] bool none() const { return waves.empty() && !unknown; }
};

bool parallel(const Wave& a, const Wave& b) {
  return std::abs(a.x * b.y - a.y * b.x) <= 1e-9 * std::hypot(a.x, a.y) * std::hypot(b.x, b.y);
}

bool share_a_wave(const Periodicity& a, const Periodicity& b) {
  if (a.none() || b.none()) return false;
  if (a.unknown || b.unknown) return true;
  return std::ranges::any_of(a.waves, [&b](const Wave& wave) {
    return std::ranges::any_of(b.waves, [&wave](const Wave& other) { return parallel(wave, other); });
  });
}

Periodicity periodicity_of(const Pattern& pattern, const Sheet& sheet);

template <typename Kind>
Periodicity periodicity(const Kind& kind, const Sheet& sheet) {
  Periodicity result;
  if constexpr (Composed<Kind>) {
    for (const PatternPart& part : kind.parts) {
      const Periodicity own = periodicity_of(part.pattern, sheet_below(kind, sheet));
      if (own.none()) continue;
      result = result.none() ? own : Periodicity{{}, true};
    }
  }
  return result;
}
Periodicity periodicity(const Ridges& ridges, const Sheet& sheet) {
  const PatternMap map = map_of(ridges, sheet);
  return {{{map.ux, map.uy}}};
}
// sin u sin v holds the waves u ± v; its square 2u and 2v besides.
Periodicity periodicity(const Sinusoid& sinusoid, const Sheet& sheet) {
  const PatternMap m = map_of(sinusoid, sheet);
  return {{{m.ux, m.uy}, {m.vx, m.vy}, {m.ux + m.vx, m.uy + m.vy}, {m.ux - m.vx, m.uy - m.vy}}};
}
Periodicity periodicity(const PatternRegions&, const Sheet&) { return {{}, true}; }

Periodicity periodicity_of(const Pattern& pattern, const Sheet& sheet) {
  return std::visit([&sheet](const auto& kind) { return periodicity(kind, sheet); }, pattern);
}

}  // namespace

bool parts_are_uncorrelated(const std::vector<PatternPart>& parts, const Sheet& sheet, std::size_t most_periodic) {
  std::vector<Periodicity> found;
  for (const PatternPart& part : parts) {
    const Periodicity own = periodicity_of(part.pattern, sheet);
    for (const Periodicity& other : found) {
      if (share_a_wave(own, other)) return false;
    }
    if (!own.none()) found.push_back(own);
  }
  return found.size() <= most_periodic;
}

}  // namespace mezzotint
