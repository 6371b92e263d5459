#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "forward/base/progress.h"
#include "forward/process/print_process.h"
#include "inverse/objective/lobe_distance.h"
#include "inverse/search/minimize.h"
#include "inverse/target/lobe_target.h"
#include "inverse/verification/verification.h"

namespace mezzotint {

/// A part of a weighted sum of distances.
struct WeightedDistance {
  LobeDistance distance = LobeDistance::CubeRoot;
  double weight = 1.0;
};

struct FreeFormOptions {
  std::size_t pixels = 128;    ///< a side of the periodic tile, 16 … 1024
  int start_evaluations = 12;  ///< of each of three trials from every start
  int evaluations = 240;       ///< from each of the best two; the best four starts get a quarter of them
  int evaluations_per_epoch = 20;
  /// What is lowered up to the last third of the epochs: the sum of weight times distance. The cube root alone finds
  /// better valleys than with L2 beside it.
  std::vector<WeightedDistance> start_objective = {{LobeDistance::CubeRoot, 1.0}};
  /// What is lowered in the last third, and what finalists are chosen by. A little L2 puts the peak right, at no cost
  /// to the cube root.
  std::vector<WeightedDistance> objective = {{LobeDistance::CubeRoot, 1.0}, {LobeDistance::L2, 0.25}};
  /// So often in the second half of the epochs what a trace shows beyond the model (shadows, further bounces, real
  /// grounds) is added to the model's maps, and kept. At normal incidence it did not help: see docs/physics.md.
  int traced_corrections = 0;
  std::size_t fresh_draws = 4;  ///< printed, for the choice and again for the verdict; 4 … 64
  std::uint64_t traced_samples = 1U << 20;
  std::string algorithm = "LD_MMA";
  Length wavelength = Length::from_nm(550.0);
  /// Where to keep what was found: read at the start if the file exists, written after every stage and when something
  /// stops the search. Going on gives the same bits as never having stopped.
  std::filesystem::path state;
  std::uint64_t seed = 1;
};

/// A relief without a pattern.
struct FreeForm {
  GrayImage gray;                ///< of the tile, rounded to the printer's levels
  std::string start;             ///< the shape that it grew from, in words
  std::vector<double> history;   ///< the objective of the time at every evaluation from the best start
  double on_search_draws = 0.0;  ///< the objective in the last epoch, gray levels continuous, ground as scatter
  Verification verified;         ///< printed and traced on draws that nothing else has met
  int evaluations = 0;           ///< of all starts
  /// In words: a goal brighter than the material, or narrower than the printer's ground scatters; a search that did not
  /// get away from its start, or that fits its own samples more than fresh ones.
  std::vector<std::string> warnings;
};

/// Every pixel of a periodic tile a variable: the gray image whose print comes closest to a goal.
///
/// Method   wanted heights, gray = γ + e^((h − α)/β), from 2β below the threshold (where nothing cures, but light
///          is taken from the foot of a cliff beside it, which makes it steeper) up to the top of the layer → light
///          → slopes of the cured relief → soft bins three times as fine as the goal's → the ground as scatter,
///          its mean over all draws (draws of it would be learned by heart) → the goal's bins; and back by the
///          adjoint. From each of several start shapes both on the start objective at once and after the Wasserstein
///          distance, which sees how far light has to go; then from the best four, then two. In every epoch the relief
///          is sampled at other places, so that little can hide between samples. The best is chosen by tracing
///          quantised prints on fresh grounds, and judged by `verify_design` on others.
/// Cost     128 pixels a side: 7 to 9 s of CPU time for the search, 1.3 to 2 s for the verdict, most of it in parallel.
/// Ctrl-C   with a `state`, what is finished and the best so far are in it (`free_form_so_far`) before the exception of
///          `progress` goes on its way.
/// @throws InvalidInput for options out of range, a goal without directions, dark or not finite, or with more light
/// than
///         came in. FileError for a state that is damaged or belongs to another problem.
[[nodiscard]] FreeForm find_free_form(const LobeTarget& goal, const PrinterProfile& printer,
                                      const FreeFormOptions& options, const Progress& progress = {});

/// The best that a search which was stopped had found: not chosen among finalists, nor judged.
struct FreeFormSoFar {
  GrayImage gray;  ///< rounded to the printer's levels
  std::string start;
  double objective = 0.0;  ///< by the model, in the epoch that it comes from
  int evaluations = 0;
};
/// @return nothing where the search was stopped before its first evaluation of the objective.
/// @throws FileError for a file that is no such state, or is damaged.
[[nodiscard]] std::optional<FreeFormSoFar> free_form_so_far(const std::filesystem::path& state,
                                                            const PrinterProfile& printer);

}  // namespace mezzotint
