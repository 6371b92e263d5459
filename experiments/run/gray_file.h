#pragma once

#include <cstddef>
#include <filesystem>

#include "forward/process/gray_image.h"

namespace mezzotint {

/// How a gray layer stands in its picture.
struct GrayFigures {
  std::size_t levels_used = 0;  ///< distinct values of its pixels
  int bits = 8;                 ///< of the picture: 16 where the printer has more than 256 levels
};

/// A layer, rounded to the printer's levels, as a gray PNG: white is full light, the first line is that of the largest
/// y (as in label pictures and in UVJ archives), and the picture's description says so.
/// @param levels  of the printer, 2 … 65536
/// @throws DeviceError where it cannot be written.
GrayFigures write_gray_png(const GrayImage& gray, int levels, const std::filesystem::path& path);

/// The distinct values of an image's pixels.
[[nodiscard]] std::size_t gray_levels_used(const GrayImage& gray);

}  // namespace mezzotint
