#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "forward/base/progress.h"
#include "forward/optics/bsdf.h"
#include "forward/surface/slope_covariance.h"
#include "inverse/verification/judge_draws.h"
#include "inverse/verification/printed_draw.h"

namespace mezzotint {

/// The gray image that a design has in the draw of a seed. A pattern's is another one for each; a free form's always
/// the same.
using GrayOfSeed = std::function<GrayImage(std::uint64_t seed)>;

struct VerificationOptions {
  DrawOptions draw;
  /// At least 4, all different, and none that the search has met.
  std::vector<std::uint64_t> seeds;
  std::uint64_t samples = 1U << 20;  ///< paths a draw and direction of the light, at most
  double tolerance = 0.0;            ///< stop a draw earlier, at this relative standard error of its map; 0: no
};

/// What a design shows when it is printed and looked at.
struct Verification {
  std::vector<std::uint64_t> seeds;
  LobeJudgement traced;    ///< by full paths: shadows, masking, and every bounce
  LobeJudgement by_slope;  ///< the same reliefs, each facet by its slope alone: what tracing changed is the difference
  std::vector<EnergyAudit> energy;   ///< of the traced light, one a direction; standard errors over the draws
  std::vector<double> wanted_light;  ///< the goal's own reflected light, to compare energy[i].reflected with
  std::vector<SlopeCovariance> slope_covariances;  ///< one a draw
};

/// Prints a design anew for every seed and traces it.
///
/// Method   `print_draw` (printer's levels, fine sub-samples at new places, fresh ground) → PathTracer in hard bins
///          of the goal's grid, for all its directions of the light → soft bins, so that it meets the goal's maps on
///          equal terms → mean over the draws → every LobeDistance with its standard error and Monte-Carlo floor.
/// Cost     0.15 s of CPU time for a draw of 128² pixels (768² samples) and 2^20 paths at normal incidence.
/// Bits     the same with any number of threads.
/// @throws InvalidInput for fewer than 4 seeds, repeated ones, a goal without directions, or what PathTracer refuses.
///         What `progress` throws.
[[nodiscard]] Verification verify_design(const GrayOfSeed& gray_of_seed, const PrinterProfile& printer,
                                         const LobeTarget& goal, const VerificationOptions& options,
                                         const Progress& progress = {});

/// A relief's reflection by full paths, in soft bins of the goal's grid, one map a direction of its light; `audits`
/// gets one a direction.
[[nodiscard]] std::vector<DirectionMap> traced_lobes(const HeightField& relief, const LobeTarget& goal,
                                                     std::uint64_t samples, double tolerance, std::uint64_t seed,
                                                     std::vector<EnergyAudit>& audits, const Progress& progress = {});

/// The same by slopes alone.
[[nodiscard]] std::vector<DirectionMap> slope_lobes(const HeightField& relief, const LobeTarget& goal);

}  // namespace mezzotint
