#pragma once

#include <string>
#include <vector>

#include "forward/pattern/pattern.h"
#include "forward/process/printer_profile.h"

namespace mezzotint {

/// How fine and how coarse a pattern may be.
struct GamutBounds {
  double least_pixels = 4.0;  ///< a wavelength, or a cell of noise along its short side; below, pixels alias
  /// Wavelengths, cells of noise along their short side, lines. A stretch may be as large as longest/shortest.
  Length longest = Length::from_um(400.0);
  Length least_height = Length::from_um(0.02);  ///< below it a pattern's slopes are lost in the ground
};

/// A number of a pattern that may be chosen between bounds, of the pattern itself or of one of its parts. All are
/// stepped by factors.
struct GamutParameter {
  std::size_t part = 0;  ///< of a sum; 0 of a simple pattern
  std::string name;      ///< as in pattern_parameters
  double low = 0.0;
  double high = 0.0;
};

/// What may be printed: a pattern, some numbers of which are free. Its direction is 0, the steeper axis x: what can be
/// reached hardly depends on it, and how much it does is part of every stated tolerance.
struct GamutKind {
  std::string name;
  Pattern pattern;
  std::vector<GamutParameter> free;
};

/// "noise", "fbm", "line_integral_convolution", "sinusoid", "ridges", "ridges+sinusoid", "ridges+sinusoid+noise".
[[nodiscard]] const std::vector<std::string>& gamut_kind_names();

/// A kind with the bounds that a printer sets: heights up to what one layer reaches, lengths from a few pixels on (of a
/// sum of octaves, those of the finest one).
/// @throws InvalidInput for an unknown name, saying which there are, or bounds that leave no room.
[[nodiscard]] GamutKind gamut_kind(const std::string& name, const PrinterProfile& printer,
                                   const GamutBounds& bounds = {});

/// The pattern with these values of its free numbers. Heights that together go beyond what a layer reaches are lowered
/// by a common factor.
[[nodiscard]] Pattern pattern_of(const GamutKind& kind, const std::vector<double>& values,
                                 const PrinterProfile& printer);

/// The same with all heights multiplied.
[[nodiscard]] std::vector<double> with_heights(const GamutKind& kind, std::vector<double> values, double factor);

/// A pattern turned so that the steeper axis stands at an angle.
[[nodiscard]] Pattern turned(Pattern pattern, Angle direction);

}  // namespace mezzotint
