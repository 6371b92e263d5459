#pragma once

#include <cstddef>
#include <vector>

#include "forward/process/printer_profile.h"
#include "forward/surface/height_field.h"

namespace mezzotint {

/// Gray values of one layer, in [0, 1], row after row; row 0 at y = 0 (archives flip it: their row 0 is on top).
struct GrayImage {
  std::size_t columns = 0;
  std::size_t rows = 0;
  std::vector<float> values;

  [[nodiscard]] float at(std::size_t column, std::size_t row) const { return values[row * columns + column]; }
};

/// @throws InvalidInput for an image without pixels, with a wrong number of values, or a value outside of [0, 1].
void require_valid(const GrayImage& image);

/// A design in gray values, and what the printer could not take of it.
struct Exposure {
  GrayImage image;
  /// Pixels that asked for more than one layer reaches (full gray, or the layer's own thickness); cut to it.
  std::size_t saturated = 0;
};

/// Heights at the pixels' centres (one sample a pixel) through the inverse cure curve.
/// @throws InvalidInput where the field's pitch is not the printer's pixel pitch, or samples are missing.
[[nodiscard]] Exposure expose(const HeightField& pixel_heights, const PrinterProfile& profile);

/// Gray values rounded to the printer's levels.
[[nodiscard]] GrayImage quantize(const GrayImage& image, const PrinterProfile& profile);

}  // namespace mezzotint
