#pragma once

#include <cstdint>
#include <vector>

#include "fabrication/slicing/placement.h"
#include "forward/process/proximity_correction.h"

namespace mezzotint {

/// What proximity correction did to a layer, or to all layers together.
struct ProximityFigures {
  double squares_before = 0.0, squares_after = 0.0;  ///< µm², summed over the pixels: printed mean − wanted mean
  std::uint64_t edge_pixels = 0;                     ///< partly covered ones
  std::uint64_t needs_more_light = 0, too_much_light = 0, finer_than_blur = 0;  ///< pixels, by `Unreached`
  ProximityFigures& operator+=(const ProximityFigures& other);
};

/// The gray levels whose print gives each pixel of a layer the mean height coverage × layer, as nearly as light allows.
/// Beyond the window it is dark.
struct ProximityLayer {
  std::vector<std::uint8_t> levels;  ///< a pixel of the window, row by row
  ProximityFigures figures;
};
/// @param coverage  a pixel of the window, in [0, 1]
/// @throws InvalidInput for another number of pixels, or a printer of more than 256 levels
[[nodiscard]] ProximityLayer correct_layer(const std::vector<float>& coverage, const PixelWindow& window,
                                           const PrinterProfile& profile, Length layer);

}  // namespace mezzotint
