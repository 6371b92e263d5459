#pragma once

#include <cstdint>
#include <vector>

#include "forward/base/progress.h"
#include "measurement/pattern_fit/noise_search.h"
#include "measurement/pattern_fit/texture_figures.h"

/// Inside of measurement/pattern_fit.

namespace mezzotint {

/// The fitted pattern, drawn again and seen like the scan: the fit to each draw, and its figures.
struct NoiseDraws {
  std::vector<NoiseNumbers> numbers;
  std::vector<TextureFigures> figures;
  double white_um4 = 0.0;        ///< density of the white noise that was added
  double white_error_um4 = 0.0;  ///< its standard error
};

/// White noise is added to the draws so that their floors are that of the fit: a part of a fit's floor is what a taper
/// lets leak and what the cut to [0, height] breaks, and the draws have that by themselves.
[[nodiscard]] NoiseDraws draw_noise(const FitView& view, const NoiseFit& fit, const NoiseSearch& search,
                                    const FigureTaker& taker, std::size_t draws, std::uint64_t seed,
                                    const Progress& progress);

/// How probable so much stretch is for a pattern without any, by the scatter of the draws' own (Hotelling's T²; the
/// likelihood alone would take impulses for Gaussian and find stretch too often).
[[nodiscard]] double probability_of_stretch(const NoiseFit& fit, const NoiseDraws& draws);

}  // namespace mezzotint
