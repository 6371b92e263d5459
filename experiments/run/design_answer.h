#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/run/stages.h"
#include "forward/process/gray_image.h"
#include "forward/surface/height_field.h"
#include "inverse/design/blur_sensitivity.h"
#include "inverse/design/design.h"
#include "inverse/verification/verification.h"

/// What a search leaves beside its figures: lobes, gray layer, relief, and how much hangs on the blur.

namespace mezzotint {

/// A print is called coarse in gray below so many levels.
inline constexpr std::size_t least_gray_levels = 14;
/// Below so many pixels a wavelength, the pixel grid shapes the relief.
inline constexpr double least_wavelength_px = 4.0;

/// Writes predicted_N.exr and target_N.exr, N the direction of the light; returns their names. Both have soft bins
/// (quadratic B-splines three bins wide), the prediction with the standard errors of its mean over the traced draws.
std::vector<std::string> write_lobes(const StageContext& context, const LobeTarget& goal, const Verification& traced);

/// Writes gray.png and relief.gwy; returns what design.json says of the layer.
[[nodiscard]] nlohmann::ordered_json write_layer(const StageContext& context, const GrayImage& gray,
                                                 const HeightField& relief);

/// The printer's spread, and the prints with others.
[[nodiscard]] nlohmann::ordered_json to_json(const PrinterProfile& printer, const std::vector<BlurredPrint>& prints);

/// "alpha_x", "relative_l2" …: every figure under its standard name as a quantity, by where it was found.
[[nodiscard]] nlohmann::ordered_json figures_to_json(const Design& design);
[[nodiscard]] nlohmann::ordered_json figures_to_json(const Verification& traced);

/// Whether the search looked at the pattern turned by a quarter, and how much worse it was there.
struct AxisSwap {
  bool is_free = false;  ///< the pattern has a direction that the search may change
  bool was_tried = false;
  double worse_by = 1.0;  ///< root of what was lowered, best of the turned places ÷ best of the others, in the scan
};
[[nodiscard]] AxisSwap axis_swap(const Design& design);

/// The shortest wavelength or cell of a pattern, in pixels.
[[nodiscard]] double shortest_length_px(const Pattern& pattern, const PrinterProfile& printer);

}  // namespace mezzotint
