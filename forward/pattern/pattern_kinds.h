#pragma once

#include <cstdint>
#include <vector>

#include "forward/base/units.h"
#include "forward/pattern/noise_lattice.h"

/// The simple kinds of pattern; u runs along `direction`, v across it. pattern.h has what can be done with them.

namespace mezzotint {

/// A point of the plane.
struct Position {
  Length x;
  Length y;
};

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

/// Fractional Brownian motion, Σ_i ℓ^(−H i) noise(p ℓ^i) over i = 0 … octaves − 1, with the deviation that `Noise`
/// has: height · (½ + Σ/√(Σ ℓ^(−2Hi))), cut to [0, height]. p as in `Noise`, for the coarsest octave. Each octave has
/// random numbers of its own, so that they do not meet in one point.
///
/// Units    mean square slope that of `Noise` times Σ ℓ^(2i(1−H)) / Σ ℓ^(−2Hi).
/// Source   Frisvad 2019; Mandelbrot and Van Ness 1968 for H, Hurst's exponent.
struct FractionalBrownianMotion {
  Length scale = Length::from_um(180.0);
  double stretch = 1.0;
  Angle direction;
  Length height = Length::from_um(16.0);
  double hurst = 0.8;
  double lacunarity = 2.0;
  int octaves = 4;
  std::uint64_t seed = 1;
  CellHash hash = CellHash::Integer;
};

/// Turbulence, Σ_i 2^(−i) |noise(2^i p)|: height · Σ / D, cut to [0, height], where D is the mean of the sum and as
/// many deviations more as make one octave reach `height` where `Noise` does. Valleys are sharp, hills round.
///
/// Units    mean square slope `octaves` times that of amplitude·noise with amplitude height / D.
/// Source   Frisvad 2019; Perlin, "An image synthesizer", SIGGRAPH 1985.
struct Turbulence {
  Length scale = Length::from_um(180.0);
  double stretch = 1.0;
  Angle direction;
  Length height = Length::from_um(16.0);
  int octaves = 4;
  std::uint64_t seed = 1;
  CellHash hash = CellHash::Integer;
};

/// A point about which a line field turns: its direction grows by `index` times the azimuth about it.
struct Singularity {
  Position place;
  double index = 1.0;  ///< a multiple of ½; a line has no head, so that half a turn brings it back
};

/// Noise smeared along lines: its mean over `length` of the field line through a point, with the deviation that
/// `Noise` has, as height · (½ + mean), cut to [0, height]: brushed and turned surfaces.
///
/// Frame    `direction` is that of the steeper slopes: the lines run across it. Without singularities it is the same
///          everywhere; with them it is direction + Σ index·azimuth about each: one of index 1 gives circles
///          (direction 0), rays (90°) and spirals; ½ and −½ the loops and deltas of a fingerprint. That is every line
///          field of the plane up to a smooth turning, in a few numbers and without a resolution of its own.
/// Source   Cabral and Leedom, "Imaging vector fields using line integral convolution", SIGGRAPH 1993; indices of line
///          fields: Hopf, "Differential geometry in the large", 1956.
struct LineIntegralConvolution {
  Length scale = Length::from_um(40.0);
  Length length = Length::from_um(400.0);
  Angle direction;
  Length height = Length::from_um(16.0);
  std::vector<Singularity> singularities;
  std::uint64_t seed = 1;
  CellHash hash = CellHash::Integer;
};

/// height · (½ sin 2π(u/λ_u + phase_u) sin 2π(v/λ_v + phase_v) + ½), u along `direction`. Phases are drawn, as seeds
/// are. Source: slide "2D sinusoid".
struct Sinusoid {
  Length wavelength_u = Length::from_um(120.0);
  Length wavelength_v = Length::from_um(120.0);
  Angle direction;
  Length height = Length::from_um(16.0);
  double phase_u = 0.0, phase_v = 0.0;  ///< in periods
};

/// Parallel ridges of triangular section; `direction` is that of their wave vector (across the crests).
/// `skew` is where the crest stands in a period: ½ is symmetric, towards 0 or 1 a saw.
struct Ridges {
  Length wavelength = Length::from_um(120.0);
  Angle direction;
  Length height = Length::from_um(16.0);
  double skew = 0.5;
  double phase = 0.0;  ///< in periods, at the origin; drawn, as seeds are
};

}  // namespace mezzotint
