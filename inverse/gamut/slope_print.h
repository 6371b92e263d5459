#pragma once

#include <cstdint>
#include <vector>

#include "forward/pattern/pattern.h"
#include "forward/process/print_process.h"
#include "inverse/gamut/slope_spectrum.h"

namespace mezzotint {

/// The patch that the gamut prints.
struct SlopePatch {
  std::size_t pixels = 96;     ///< a side
  std::size_t subsamples = 3;  ///< a pixel and axis
  std::size_t draws = 2;       ///< of every pattern, 1…64
  std::uint64_t seed = 1;
};

/// Mean square slopes of a print, along the pattern's own axes, with the standard error of each over the draws
/// (0 with one draw).
struct PrintedSquares {
  AxisSquares mean;
  AxisSquares standard_error;
};

/// The slopes of patterns as the real process prints them: gray → light → cure height, at single points, before the
/// ground. Safe to use from several threads.
///
/// Draws    a small patch holds few cells and broken periods. What its draw lacks or has too much shows as well in the
///          unprinted heights, whose expectation is known (`pixel_difference_slopes`): the print's slopes are divided
///          by theirs and multiplied by it. So a patch of 96 pixels tells the slopes of a large print to 1–2 %.
/// Gray     values as they are, not rounded to the printer's levels: 8 bits move slopes by less than 1 % from heights
///          of 2 µm on, and less than the ground below.
class SlopePrint {
public:
  /// @throws InvalidInput as PrintProcess, or for no draws.
  SlopePrint(const PrinterProfile& printer, const SlopePatch& patch);

  /// @throws InvalidInput for a pattern without closed form (slope_spectrum.h), or one that is not of direction 0.
  [[nodiscard]] PrintedSquares squares(const Pattern& pattern) const;

  /// Of the patch alone, in the pattern's own frame, whatever its direction; for tests, and for how much it matters.
  [[nodiscard]] SlopeCovariance raw(const Pattern& pattern, std::size_t draw) const;

  [[nodiscard]] const PrinterProfile& printer() const { return printer_; }

private:
  struct Draw {
    SlopeCovariance printed, unprinted;
  };
  [[nodiscard]] Draw draw(const Pattern& pattern, std::size_t index) const;

  PrinterProfile printer_;
  SlopePatch patch_;
  PrintProcess process_;
};

}  // namespace mezzotint
