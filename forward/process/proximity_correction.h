#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "forward/process/gray_image.h"
#include "forward/process/printed_relief.h"

namespace mezzotint {

/// Why a pixel's relief does not come out as wanted.
enum class Unreached : std::uint8_t {
  None,            ///< it does, to the tolerance
  NeedsMoreLight,  ///< it, or a neighbour that could help, is at full gray and still too low
  TooMuchLight,    ///< it, or a neighbour that could help, is dark already and what the others give cures too much
  FinerThanBlur    ///< no bound is in the way: the pixels' light is too smooth, or their levels too coarse
};

struct CorrectionOptions {
  std::size_t steps = 40;                   ///< at most; 0 leaves the gray values as `expose` gives them
  Length tolerance = Length::from_um(0.2);  ///< of a pixel's RMS error, for the map
  /// Side of a tile of a big picture, 16 …; small ones leave out more of what is uniform, and pay more for their halos.
  std::size_t tile_pixels = 224;
};

/// Gray values that print a wanted relief, and what they cannot print of it.
struct ProximityCorrection {
  GrayImage image;  ///< in the printer's levels
  /// RMS of printed − wanted at the samples, both in the printer's levels: of `expose`d heights, and of `image`.
  Length error_before, error_after;
  std::size_t saturated = 0;         ///< wanted samples higher than one layer reaches; cut to it before the rest
  std::vector<float> residual_um;    ///< a pixel: RMS of its samples' errors, with the sign of their mean
  std::vector<Unreached> unreached;  ///< a pixel
  /// Pixels of each reason, in the order of the enumeration.
  [[nodiscard]] std::array<std::size_t, 4> counts() const;
};

/// Proximity correction: what should come out decides what is projected. Finds the gray values in [0, 1] whose print
/// comes closest to a relief (least squares of heights at the samples), and rounds them to the printer's levels.
///
/// Shape    `wanted` has either one sample a sub-pixel, as `print_layer` gives them (the height wanted there), or one a
///          pixel (the mean height wanted over it). Lower than 0 counts as 0, more than is reachable as reachable.
/// Method   fixed-point steps in dose: a pixel's dose is multiplied by e^(r/β), r the error of the heights around it,
///          each weighted with the share of its light that this pixel gives; without a parameter to tune. They lower
///          a quadratic bound of the error (the rows of the shares sum to 1), and are accelerated and restarted as in
///          Nesterov 1983 and O'Donoghue and Candès 2015; the best of all is kept. For a linear process this is SIRT
///          (Gilbert 1972).
/// Big      pictures are solved in tiles with a halo under a Gaussian, whose reach is short; a few bytes a sample. The
///          result has the same bits with any number of threads.
/// Errors   InvalidInput for missing samples, or a size that is neither of the two.
[[nodiscard]] ProximityCorrection correct_proximity(const HeightField& wanted, const PrinterProfile& profile,
                                                    const ProcessOptions& process,
                                                    const CorrectionOptions& options = {});

}  // namespace mezzotint
