#pragma once

#include <map>
#include <string>

#include "inverse/target/lobe_target.h"
#include "recovery_families.h"

namespace mezzotint::benchmark {

/// A way to find a design, as words: a name, and what differs from its default, "plain:objective=l2:rays=1e6".
///
/// plain    NLopt straight on fresh Monte Carlo at full resolution, as one would write it first: every evaluation
///          draws the pattern anew, prints it (the ladder's patch, 4 × 4 samples a pixel, gray levels continuous, a
///          ground of its own), traces it with paths of a seed of its own and lowers a measure of the map.
///          algorithm  LN_BOBYQA; NLopt's names
///          objective  cube_root; a sum of measures, "cube_root+moments"
///          rays       1e5, in all directions of the light together
///          start      centre (of the box; in logarithms where that is the scale), or closed (the ladder's own start)
///          tracer     embree (random positions, no control variate, both branches of an interaction followed by their
///                     shares), roulette (the same, one branch followed, as in the slides), own (our tracer's defaults)
///          cap        200 evaluations; the tolerance is the ladder's, 1e-3
/// ladder   search_pattern, then polish_traced.
///          algorithm, objective (none: it chooses), cap (300), scanned, starts, coarse, draws, pixels, subsamples,
///          corrections, evaluations, traced_draws, log2_paths
/// moments  the ladder's first rung alone: slopes alone are lowered, no light.
/// truth    the pattern that the target was made of: what noise leaves.
struct RaceMethod {
  std::string name;
  std::map<std::string, std::string> words;
};
/// @throws InvalidInput for a word that the method has not.
[[nodiscard]] RaceMethod race_method(const std::string& text);

struct RaceResult {
  Pattern pattern;
  double evaluations = 0.0;  ///< of the ladder: evaluations of its slope model on all draws, and what counts as such
  double cpu_seconds = 0.0, wall_seconds = 0.0;
};

/// Finds a pattern of the family that shows the goal's lobes.
[[nodiscard]] RaceResult race(const RaceMethod& method, const Family& family, const LobeTarget& goal,
                              const Pattern& truth, std::uint64_t seed);

}  // namespace mezzotint::benchmark
