#include "fabrication/job/preview.h"

#include <algorithm>

#include "fabrication/job/png_picture.h"

namespace mezzotint {

std::string preview_png(const LayerPicture& layer, std::size_t columns, std::size_t rows) {
  const double scale = std::max(static_cast<double>(layer.columns) / static_cast<double>(columns),
                                static_cast<double>(layer.rows) / static_cast<double>(rows));
  const auto fitted = [scale](std::size_t pixels, std::size_t most) {
    const auto size = static_cast<std::size_t>(static_cast<double>(pixels) / scale);
    return std::clamp<std::size_t>(size, 1, most);
  };
  const std::size_t width = fitted(layer.columns, columns), height = fitted(layer.rows, rows);
  const std::size_t left = (columns - width) / 2, top = (rows - height) / 2;
  std::vector<std::uint8_t> picture(columns * rows * 3, 0), row_pixels(layer.columns);
  for (std::size_t y = 0; y < height; ++y) {
    std::fill(row_pixels.begin(), row_pixels.end(), std::uint8_t{0});
    for (const GrayRun& run : runs_of_row(layer, layer.rows - 1 - y * layer.rows / height))
      std::fill(row_pixels.begin() + run.begin, row_pixels.begin() + run.end, run.level);
    for (std::size_t x = 0; x < width; ++x) {
      std::fill_n(picture.begin() + static_cast<std::ptrdiff_t>(((top + y) * columns + left + x) * 3), 3,
                  row_pixels[x * layer.columns / width]);
    }
  }
  return encode_png(picture, columns, rows, 3);
}

}  // namespace mezzotint
