#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "forward/base/units.h"
#include "forward/process/cure_curve.h"

namespace mezzotint {

/// One octave of the printer's own relief: amplitude · noise(p / scale).
struct GroundOctave {
  double weight = 0.0;  ///< times the amplitude of the ground
  Length scale;
};

/// How the projector's optics spread the light of a pixel, in the plane of the resin.
///
/// Gaussian    standard deviation `width`. The usual model; its tails end.
/// Lorentzian  k(r) = w/(2π (r² + w²)^(3/2)), w = `width`: the bivariate Cauchy distribution, whose transfer is
///             e^(−2πw|f|); seen along any axis it is a Lorentzian of half width w at half maximum. Half of the light
///             falls within √3·w and 1 − 1/√(1 + (r/w)²) within r: heavy tails, as stray light in a lens makes them.
/// Source      Reid et al., 3D Printing and Additive Manufacturing 11 (2024), 517: heavy tails fit small positive and
///             small negative features better than a Gaussian.
struct PixelSpread {
  enum class Kernel { Gaussian, Lorentzian };
  Kernel kernel = Kernel::Gaussian;
  Length width = Length::from_um(3.77);  ///< 0: each pixel keeps its light
  bool calibrated = false;
};

/// "gaussian", "lorentzian".
[[nodiscard]] std::string_view kernel_name(PixelSpread::Kernel kernel);

/// What is known of a printer: everything between a design and its printed relief.
///
/// Source   Frisvad 2019 (2560 × 1600 micromirrors at 7.54 µm, layer 18 µm, exposure 3 s, LED amplitude 230).
///          The blur and the amplitude of the ground are not on the slides: assumed until calibrated, and
///          said so in every report.
struct PrinterProfile {
  std::string name = "dlp9000";
  std::size_t pixels_x = 2560;
  std::size_t pixels_y = 1600;
  Length pixel_pitch = Length::from_um(7.54);
  Length layer = Length::from_um(18.0);
  double exposure_s = 3.0;
  int led_amplitude = 230;
  int gray_levels = 256;
  CureCurve cure;
  PixelSpread spread;
  Length ground_amplitude = Length::from_um(1.0);
  bool ground_is_calibrated = false;
  std::vector<GroundOctave> ground = {
      {2.0 / 3.0, Length::from_um(50.0)}, {1.0 / 9.0, Length::from_um(25.0)}, {1.0 / 12.0, Length::from_um(2.0)}};
};

/// @throws InvalidInput for values without meaning (no pixels, gray levels outside of 2…65536, negative
///         lengths, an invalid cure curve), naming the key of the profile file.
void require_valid(const PrinterProfile& profile);

/// Largest height that one layer reaches: full gray, or the layer where that is less.
[[nodiscard]] Length reachable_height(const PrinterProfile& profile);

}  // namespace mezzotint
