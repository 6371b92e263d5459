#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "forward/base/progress.h"
#include "forward/process/print_process.h"
#include "inverse/objective/lobe_distance.h"
#include "inverse/search/minimize.h"
#include "inverse/target/lobe_target.h"

namespace mezzotint {

struct FreeFormOptions {
  std::size_t pixels = 128;    ///< a side of the periodic tile, 16 … 1024
  int start_evaluations = 20;  ///< of each of three trials from every start
  int evaluations = 200;       ///< from the best two, on the cube root
  int evaluations_per_epoch = 25;
  std::size_t fresh_draws = 4;  ///< of the printer's ground, for the choice and again for the verdict
  std::string algorithm = "LD_MMA";
  Length wavelength = Length::from_nm(550.0);
  std::uint64_t seed = 1;
};

/// A distance to the goal on draws that the search has not seen.
struct FreshDistance {
  LobeDistance distance;
  double value = 0.0;  ///< mean over directions of the light
};

/// A relief without a pattern.
struct FreeForm {
  GrayImage gray;                    ///< of the tile, rounded to the printer's levels
  std::string start;                 ///< the shape that it grew from, in words
  std::vector<double> history;       ///< cube-root distance of every evaluation from the best start
  double on_search_draws = 0.0;      ///< cube-root distance in the last epoch, gray levels continuous, no ground
  std::vector<FreshDistance> fresh;  ///< all distances, on fresh draws, as printed
  int evaluations = 0;
};

/// Every pixel of a periodic tile a variable: the gray image whose print comes closest to a goal.
///
/// Method   wanted heights between the threshold and the top of the layer → gray → light → slopes of the cured relief →
///          soft bins, and back by the adjoint. From each of several start shapes both on the cube root at once and
///          after the Wasserstein distance, which sees how far light has to go; then from the best two on the cube
///          root. In every epoch the relief is sampled at other places (3 a pixel and axis), so that nothing can hide
///          between samples. The printer's ground is met as scatter, its mean over all draws: draws of it would be
///          learned by heart. The best is chosen and judged by real draws, each its own, with the printer's gray
///          levels.
/// @throws InvalidInput for options out of range, or a goal without directions.
[[nodiscard]] FreeForm find_free_form(const LobeTarget& goal, const PrinterProfile& printer,
                                      const FreeFormOptions& options, const Progress& progress = {});

}  // namespace mezzotint
