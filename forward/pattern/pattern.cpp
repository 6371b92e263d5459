#include "forward/pattern/pattern.h"

#include <algorithm>
#include <cmath>

#include "forward/pattern/pattern_drawing.h"
#include "forward/pattern/pattern_moments.h"
#include "forward/pattern/pattern_parameters.h"
#include "forward/pattern/pattern_tree.h"

namespace mezzotint {

namespace {

Length highest(const std::vector<PatternPart>& parts) {
  Length most;
  for (const PatternPart& part : parts) most = std::max(most, height_of(part.pattern));
  return most;
}

template <typename Kind>
Length height(const Kind& kind) {
  return kind.height;
}
Length height(const PatternSum& sum) {
  Length total;
  for (const PatternPart& part : sum.parts) total = total + height_of(part.pattern);
  return total;
}
Length height(const TurnedPattern& turned) { return highest(turned.parts); }
// Of the two that are seen; the mask's own height means nothing.
Length height(const MaskedPattern& masked) {
  return std::max(height_of(masked.parts.at(0).pattern), height_of(masked.parts.at(1).pattern));
}
Length height(const PatternRegions& regions) { return highest(regions.parts); }

Sheet sheet_of(const Grid& grid, const Position& origin, Continuation continuation) {
  return {grid, {.u0 = origin.x.um(), .v0 = origin.y.um()}, continuation};
}

double change(const PatternMap& wanted, const PatternMap& fit) {
  return std::max(std::hypot(fit.ux - wanted.ux, fit.uy - wanted.uy) / std::hypot(wanted.ux, wanted.uy),
                  std::hypot(fit.vx - wanted.vx, fit.vy - wanted.vy) / std::hypot(wanted.vx, wanted.vy));
}

double fit_change(const Pattern& pattern, const Sheet& sheet) {
  return std::visit(
      [&sheet]<typename Kind>(const Kind& kind) {
        double most = 0.0;
        if constexpr (requires { map_of(kind, sheet); }) {
          const PatternMap wanted = map_of(kind, sheet);
          most = change(wanted, std::is_same_v<Kind, Ridges> ? fitted_along_u(wanted, sheet) : fitted(wanted, sheet));
        }
        if constexpr (Composed<Kind>) {
          for (const PatternPart& part : kind.parts) {
            most = std::max(most, fit_change(part.pattern, sheet_below(kind, sheet)));
          }
        }
        return most;
      },
      pattern);
}

}  // namespace

std::string_view kind_name(const Pattern& pattern) { return pattern_kinds().at(pattern.index()); }

const std::vector<PatternPart>* parts_of(const Pattern& pattern) {
  return std::visit(
      []<typename Kind>(const Kind& kind) -> const std::vector<PatternPart>* {
        if constexpr (Composed<Kind>) return &kind.parts;
        return nullptr;
      },
      pattern);
}

Length height_of(const Pattern& pattern) {
  return std::visit([](const auto& kind) { return height(kind); }, pattern);
}

HeightField synthesize(const Pattern& pattern, const Grid& grid, const Position& origin, Continuation continuation) {
  require_valid(pattern);
  require_valid_grid(grid);
  const Sheet sheet = sheet_of(grid, origin, continuation);
  return heights_of(draw_gray(with_independent_parts(pattern), sheet), pattern, grid, continuation);
}

double periodic_change(const Pattern& pattern, const Grid& grid) {
  require_valid(pattern);
  require_valid_grid(grid);
  return fit_change(pattern, sheet_of(grid, {}, Continuation::Periodic));
}

std::optional<SlopeCovariance> closed_form_slope_covariance(const Pattern& pattern) {
  require_valid(pattern);
  const auto moments = closed_form_moments(pattern, sheet_of({}, {}, Continuation::Mirrored));
  if (!moments) return {};
  const double square = height_of(pattern).um() * height_of(pattern).um();
  return SlopeCovariance{moments->slopes.xx * square, moments->slopes.yy * square, moments->slopes.xy * square};
}

PatternInstance draw_instance(const Pattern& pattern, std::uint64_t seed) {
  PatternInstance instance{pattern, {}};
  draw_all(instance.pattern, seed);
  return instance;
}

std::optional<Randomness> randomness(const Pattern& pattern) {
  return std::visit(
      []<typename Kind>(const Kind& kind) -> std::optional<Randomness> {
        if constexpr (Random<Kind>) return Randomness{kind.seed, kind.hash};
        return {};
      },
      pattern);
}

void set_randomness(Pattern& pattern, const Randomness& randomness) {
  std::visit(
      [&]<typename Kind>(Kind& kind) {
        if constexpr (Random<Kind>) {
          kind.seed = randomness.seed;
          kind.hash = randomness.hash;
        }
      },
      pattern);
}

}  // namespace mezzotint
