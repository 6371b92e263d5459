#pragma once

#include <string_view>
#include <vector>

#include "inverse/objective/lobe_distance.h"
#include "inverse/target/lobe_target.h"

namespace mezzotint {

/// The lobe of a print in the mean over its draws, in soft bins; the standard error of every bin is that of the mean,
/// from the spread between draws.
struct MeanLobe {
  DirectionMap mean, standard_error;
  DirectionMap half_a, half_b;  ///< means of every other draw: independent of each other
};

/// How far the mean lobe of some draws is from a goal, by one distance: as a square (what `lobe_distance` gives and
/// searches lower; named by `name_of`) and as its root (a relative error; named by `root_name_of`).
///
/// Standard errors   delete-one jackknife over the draws.
/// floor             the square that noise alone gives: the mean of so many draws, to what it would be with ever more
///                   draws and rays. Both the scatter of the draws and the noise of a tracer are in it. It is the
///                   distance of the mean of half of the draws from the mean of all of them, which differ by just as
///                   much noise (in the mean over all ways to cut the draws in a ring): no law is assumed of how the
///                   distance grows. Found within 10 % of the truth, on synthetic noise; the cube root's, where a ray
///                   or two hit most bins of the flanks, is 30 % too low. A design at its floor may be better than it
///                   reads; more draws would tell.
struct JudgedDistance {
  LobeDistance distance = LobeDistance::L2;
  Estimate square, root;
  Estimate floor;           ///< of the square
  double root_floor = 0.0;  ///< √floor
};

/// "relative_l2", "cube_root_error", "log_error", "sliced_wasserstein_error", "moments_error": the roots.
[[nodiscard]] std::string_view root_name_of(LobeDistance distance);

struct LobeJudgement {
  std::vector<MeanLobe> lobes;            ///< one a direction of the light
  std::vector<JudgedDistance> distances;  ///< in the order of all_lobe_distances; means over the directions
  std::vector<Estimate> reflected;        ///< light, ∫ f cosθ dω, one a direction

  [[nodiscard]] const JudgedDistance& by(LobeDistance distance) const;
};

/// Lobes of independent draws, one map in soft bins a direction of the light, against a goal.
/// @throws InvalidInput for fewer than 4 draws, or maps that do not fit the goal.
[[nodiscard]] LobeJudgement judge_draws(const std::vector<std::vector<DirectionMap>>& draws, const LobeTarget& goal);

/// ∫ f cosθ dω of each of the goal's own maps.
[[nodiscard]] std::vector<double> wanted_light(const LobeTarget& goal);

}  // namespace mezzotint
