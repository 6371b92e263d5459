#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "forward/process/proximity_correction.h"

/// Inside of forward/process.

namespace mezzotint {

/// A piece of a picture whose gray values are sought.
struct ProximityTile {
  std::size_t columns = 0, rows = 0;  ///< pixels
  std::vector<float> wanted_um;       ///< a sample, or a pixel; within 0 and what is reachable
  std::vector<std::uint8_t> dark;     ///< a pixel: 1 where nothing shines and nothing is wanted; empty for none
};

/// Printed − wanted of an image: at the samples, or of the pixels' means where the wanted heights are means.
[[nodiscard]] std::vector<float> relief_errors(const ProximityTile& tile, const GrayImage& image,
                                               const PrinterProfile& profile, const ProcessOptions& process);

/// The gray values before correction: each pixel on its own, from its mean wanted height.
[[nodiscard]] GrayImage exposed(const ProximityTile& tile, const PrinterProfile& profile);

/// The corrected gray values, not yet rounded.
[[nodiscard]] GrayImage solve_proximity(const ProximityTile& tile, const PrinterProfile& profile,
                                        const ProcessOptions& process, std::size_t steps);

}  // namespace mezzotint
