#pragma once

#include <string>
#include <vector>

#include "forward/base/progress.h"
#include "measurement/pattern_fit/whittle.h"

/// Inside of measurement/pattern_fit.

namespace mezzotint {

/// The noise-like patterns that were tried on a scan, the likeliest first, and the blocks on which they compete: not
/// those where the likeliest of a first round is lost in its floor, so that what a taper lets leak decides nothing.
struct NoiseSearch {
  std::vector<std::size_t> used;  ///< numbers of the view's blocks
  SeenSpectrum seen;
  std::vector<NoiseFit> fits;
};

/// A part of a view's spectrum.
[[nodiscard]] SeenSpectrum spectrum_of(const FitView& view, const std::vector<double>& density_um4,
                                       const std::vector<std::size_t>& used);

/// What a likelihood loses for its free numbers: half of ln(frequencies) for each (Schwarz 1978).
[[nodiscard]] double penalised(const NoiseFit& fit, const SeenSpectrum& seen);

/// The same pattern, alike in all directions.
[[nodiscard]] NoiseFit without_stretch(const NoiseFit& fit, const SeenSpectrum& seen);

struct WantedNoise {
  bool noise = true, fbm = true;
};

/// `noise`, and `fbm` of 2 to 8 octaves (lacunarity 2; another one where the likelihood asks for it), each with and
/// without stretch, from a table of starts.
[[nodiscard]] NoiseSearch search_noise(const FitView& view, const std::vector<double>& density_um4,
                                       const WantedNoise& wanted, const Progress& progress);

}  // namespace mezzotint
