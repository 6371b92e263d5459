#pragma once

#include <cstdint>
#include <vector>

#include "forward/pattern/pattern_kinds.h"

/// Inside of forward/pattern, and for the start of a search.

namespace mezzotint {

/// A layer of noise in a sum: weight · noise(p · frequency), with random numbers of its own.
struct Octave {
  double frequency = 1.0;
  double weight = 1.0;
  std::uint64_t seed = 1;
};

/// A noise-like pattern as a sum of octaves: gray = offset + Σ weight·n, or of |n|.
struct OctaveSum {
  std::vector<Octave> octaves;
  double offset = 0.5;
  bool absolute = false;
};

[[nodiscard]] OctaveSum octave_sum(const Noise& noise);
[[nodiscard]] OctaveSum octave_sum(const FractionalBrownianMotion& motion);
[[nodiscard]] OctaveSum octave_sum(const Turbulence& turbulence);

/// How an octave's weight grows with H and with ℓ, relatively: ∂ln weight/∂H and ∂ln weight/∂ℓ.
struct WeightSlopes {
  double toward_hurst = 0.0, toward_lacunarity = 0.0;
};
[[nodiscard]] WeightSlopes weight_slopes(const FractionalBrownianMotion& motion, int octave);

}  // namespace mezzotint
