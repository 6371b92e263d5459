#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <variant>

#include "forward/pattern/pattern_compositions.h"
#include "forward/pattern/pattern_kinds.h"
#include "forward/surface/height_field.h"
#include "forward/surface/slope_covariance.h"

namespace mezzotint {

/// What is printed on purpose.
using Pattern = std::variant<Noise, FractionalBrownianMotion, Turbulence, LineIntegralConvolution, Sinusoid, Ridges,
                             PatternSum, PatternProduct, TurnedPattern, MaskedPattern, PatternRegions>;

/// A pattern within another.
struct PatternPart {
  Pattern pattern;
  int label = 0;  ///< the value of its pixels; for regions
};

/// "noise", "fbm", "turbulence", "line_integral_convolution", "sinusoid", "ridges"; "sum", "product", "rotate", "mask",
/// "regions".
[[nodiscard]] std::string_view kind_name(const Pattern& pattern);

/// Its parts; null for a simple kind.
[[nodiscard]] const std::vector<PatternPart>* parts_of(const Pattern& pattern);

/// The height of the highest possible point over the lowest.
[[nodiscard]] Length height_of(const Pattern& pattern);

/// Limits of a composition: 16 parts (256 regions), 8 levels, 512 patterns in all.
/// @throws InvalidInput for a parameter outside of its range (pattern_parameters), a length that is not finite, or a
///         composition without the parts that it needs.
void require_valid(const Pattern& pattern);

/// The pattern on a grid: sample (c, r) is its height over its own zero, in [0, height_of], at
/// (c·pitch_x, r·pitch_y) + origin.
///
/// With Continuation::Periodic the tile holds whole numbers of periods along both sides: the pattern's lengths and
/// direction are changed as little as that needs (periodic_change), whatever its direction.
/// @throws InvalidInput for a tile that is too small for it, or a line field with singularities, which fits no tile.
[[nodiscard]] HeightField synthesize(const Pattern& pattern, const Grid& grid, const Position& origin = {},
                                     Continuation continuation = Continuation::Mirrored);

/// By how much, relatively, a pattern is stretched, sheared or turned to fit a periodic grid; of a composition, the
/// largest change of a part.
[[nodiscard]] double periodic_change(const Pattern& pattern, const Grid& grid);

/// Closed-form slope covariance before the cut to [0, height] and before printing.
///
/// None for what has no such form: a line field with singularities (its slopes depend on the place), masks and regions
/// (cliffs), and a sum or product of periodic parts that share a direction, which may beat or add up.
/// Source   noise on the lattice plane: E|∇₂n|² = 0.8427; sinusoid and ridges: elementary. Line integral convolution:
///          quadrature of the noise's stationary autocorrelation, within 3 %. Compositions: independent stationary
///          parts; of a product E[(fg)_x²] = E f_x² E g² + E f² E g_x².
[[nodiscard]] std::optional<SlopeCovariance> closed_form_slope_covariance(const Pattern& pattern);

/// Another draw of the same texture: noises get another seed; sinusoids and ridges, which have no randomness of their
/// own, other phases, in a composition each its own.
struct PatternInstance {
  Pattern pattern;
  Position origin;  ///< where to look at it: at its own origin
};
[[nodiscard]] PatternInstance draw_instance(const Pattern& pattern, std::uint64_t seed);

/// What tells one draw of a random texture from another. None for kinds without randomness, and for compositions.
struct Randomness {
  std::uint64_t seed = 1;
  CellHash hash = CellHash::Integer;
};
[[nodiscard]] std::optional<Randomness> randomness(const Pattern& pattern);
void set_randomness(Pattern& pattern, const Randomness& randomness);

}  // namespace mezzotint
