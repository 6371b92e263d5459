#include "forward/pattern/octave_sum.h"

#include <cmath>

#include "forward/base/random.h"
#include "forward/pattern/sparse_noise.h"

namespace mezzotint {

namespace {

// The first octave keeps the pattern's seed: one octave is the noise itself.
std::uint64_t octave_seed(std::uint64_t seed, int octave) {
  if (octave == 0) return seed;
  const auto words = RandomStream(seed, RandomPurpose::PatternPart).bits4(static_cast<std::uint64_t>(octave));
  return std::uint64_t{words[0]} << 32U | words[1];
}

}  // namespace

OctaveSum octave_sum(const Noise& noise) { return {{{1.0, 1.0, noise.seed}}}; }

OctaveSum octave_sum(const FractionalBrownianMotion& motion) {
  OctaveSum sum;
  double squares = 0.0;
  for (int i = 0; i < motion.octaves; ++i) {
    const double weight = std::pow(motion.lacunarity, -motion.hurst * i);
    squares += weight * weight;
    sum.octaves.push_back({std::pow(motion.lacunarity, i), weight, octave_seed(motion.seed, i)});
  }
  for (Octave& octave : sum.octaves) octave.weight /= std::sqrt(squares);
  return sum;
}

// weight_i = a_i/√Σa², a_i = ℓ^(−H i): with ln a_i = −H i ln ℓ, ∂ln weight_i = ∂ln a_i − Σ weight²·∂ln a.
WeightSlopes weight_slopes(const FractionalBrownianMotion& motion, int octave) {
  const OctaveSum sum = octave_sum(motion);
  double mean = 0.0;
  for (int i = 0; i < motion.octaves; ++i) {
    const double weight = sum.octaves[static_cast<std::size_t>(i)].weight;
    mean += weight * weight * i;
  }
  const double coarser = mean - octave;
  return {coarser * std::log(motion.lacunarity), coarser * motion.hurst / motion.lacunarity};
}

OctaveSum octave_sum(const Turbulence& turbulence) {
  OctaveSum sum;
  sum.offset = 0.0;
  sum.absolute = true;
  double weights = 0.0, squares = 0.0;
  for (int i = 0; i < turbulence.octaves; ++i) {
    const double weight = std::pow(2.0, -i);
    weights += weight;
    squares += weight * weight;
    sum.octaves.push_back({std::pow(2.0, i), weight, octave_seed(turbulence.seed, i)});
  }
  const double mean = mean_noise_magnitude;
  // One octave is to reach 1 at |n| = ½.
  const double divisor = mean * weights + (0.5 - mean) * std::sqrt(squares);
  for (Octave& octave : sum.octaves) octave.weight /= divisor;
  return sum;
}

}  // namespace mezzotint
