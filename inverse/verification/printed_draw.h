#pragma once

#include <cstdint>

#include "forward/process/print_process.h"

namespace mezzotint {

/// How a verification prints.
struct DrawOptions {
  std::size_t subsamples = 6;  ///< samples of the relief a pixel and axis; finer than a search's
  Surround surround = Surround::Mirror;
  Length wavelength = Length::from_nm(550.0);  ///< decides which octaves of the ground are geometry
};

/// One print of a gray image, as no search has met it: rounded to the printer's levels, sampled at sub-pixel places of
/// this draw's own, on a ground of this draw's own.
///
/// Ground   its geometric octaves (`split_ground`). Under Surround::Repeat it closes with the tile: over half of the
///          tile, or four times the coarsest octave where that is less, what lies beyond the end is faded over what
///          lies behind the start, by weights whose squares sum to 1 (so that the variance is kept); without that the
///          seam would be a cliff that scatters.
/// @param seed  of the ground and the places; draws with other seeds are independent.
/// @throws InvalidInput as `print_layer`.
[[nodiscard]] HeightField print_draw(const GrayImage& image, const PrinterProfile& printer, const DrawOptions& options,
                                     std::uint64_t seed);

}  // namespace mezzotint
