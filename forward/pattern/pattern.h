#pragma once

#include <cstdint>
#include <string_view>
#include <variant>

#include "forward/base/units.h"
#include "forward/pattern/noise_lattice.h"
#include "forward/surface/height_field.h"
#include "forward/surface/slope_covariance.h"

namespace mezzotint {

/// Sparse convolution noise as relief: height · (½ + noise(p)), cut to [0, height]; p = the position along
/// `direction` divided by `scale`, and across it divided by scale·stretch.
///
/// Frame    `direction` is that of the steeper slopes (the short side of the grains), from +x.
/// Units    RMS slope along `direction` 0.649·height/scale before the cut, which takes 0.1 % of the samples.
/// Source   Frisvad 2019, slide "Noise".
struct Noise {
  Length scale = Length::from_um(90.0);
  double stretch = 1.0;
  Angle direction;
  Length height = Length::from_um(16.0);
  std::uint64_t seed = 1;
  CellHash hash = CellHash::Integer;
};

/// height · (½ sin(2πu/λ_u) sin(2πv/λ_v) + ½), u along `direction`. Source: slide "2D sinusoid".
struct Sinusoid {
  Length wavelength_u = Length::from_um(120.0);
  Length wavelength_v = Length::from_um(120.0);
  Angle direction;
  Length height = Length::from_um(16.0);
};

/// Parallel ridges of triangular section; `direction` is that of their wave vector (across the crests).
/// `skew` is where the crest stands in a period: ½ is symmetric, towards 0 or 1 a saw.
struct Ridges {
  Length wavelength = Length::from_um(120.0);
  Angle direction;
  Length height = Length::from_um(16.0);
  double skew = 0.5;
};

/// What is printed on purpose.
using Pattern = std::variant<Noise, Sinusoid, Ridges>;

/// "noise", "sinusoid", "ridges".
[[nodiscard]] std::string_view kind_name(const Pattern& pattern);

/// @throws InvalidInput for lengths that are not positive and finite, stretch outside of [1, 64], skew
///         outside of [0.01, 0.99].
void require_valid(const Pattern& pattern);

/// A point of the plane.
struct Position {
  Length x;
  Length y;
};

/// The pattern on a grid: sample (c, r) is its height over its own zero, in [0, height], at
/// (c·pitch_x, r·pitch_y) + origin. Not periodic: a pattern with a free direction fits no tile.
[[nodiscard]] HeightField synthesize(const Pattern& pattern, const Grid& grid, const Position& origin = {});

/// Closed-form slope covariance before the cut to [0, height] and before printing.
/// Source   noise on the lattice plane: E|∇₂n|² = 0.8427; sinusoid and ridges: elementary.
[[nodiscard]] SlopeCovariance closed_form_slope_covariance(const Pattern& pattern);

/// Another draw of the same texture: a noise gets another seed; the other kinds have no randomness of their
/// own and are shifted by a part of their period.
struct PatternInstance {
  Pattern pattern;
  Position origin;
};
[[nodiscard]] PatternInstance draw_instance(const Pattern& pattern, std::uint64_t seed);

}  // namespace mezzotint
