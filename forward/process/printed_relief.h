#pragma once

#include <cstdint>

#include "forward/pattern/pattern_kinds.h"
#include "forward/process/gray_image.h"

namespace mezzotint {

/// ∂z/∂x and ∂z/∂y of a relief, one each a sample; or the slopes of a scalar J toward them.
struct ReliefSlopes {
  std::vector<float> x, y;
};

/// What surrounds the patch in the projector's image.
enum class Surround {
  Repeat,  ///< the patch is a periodic tile
  Mirror,  ///< more of the same texture: for searches on a part of a larger print
  Dark     ///< nothing: the patch ends, as in a print of the patch alone
};

struct ProcessOptions {
  std::size_t subsamples = 4;  ///< samples a pixel and axis of the printed relief, 1…16
  Surround surround = Surround::Mirror;
  double place_x = 0.5;  ///< where a sample stands within its sub-pixel, 0 … 1; ½ is its middle
  double place_y = 0.5;
};

/// The light that arrives at the resin: each pixel a square of its gray value, spread by the profile's
/// kernel, sampled `subsamples` times a pixel and axis at the centres of the sub-pixels. Exact for piecewise
/// constant pixels: a Gaussian by differences of the error function, cut at 5σ and normalised; a Lorentzian, which
/// nothing cuts, by its closed form over a rectangle (copies of the patch that are far away shine as if smeared out,
/// right to 1e-6).
///
/// Shape    columns·subsamples × rows·subsamples; pitch = pixel pitch / subsamples.
/// Errors   InvalidInput for an invalid image or profile, subsamples outside of 1…16, or more than 2^30 samples.
[[nodiscard]] GrayImage spread_light(const GrayImage& image, const PrinterProfile& profile,
                                     const ProcessOptions& options);

/// The relief that one layer prints: spread light, cure curve, cut at the layer's thickness (there is no more
/// resin between the part and the window). Without ground noise. Samples as `spread_light`; sample (0, 0)
/// lies half a sub-pixel inside of the picture's corner. Heights are right to 1e-5 µm (float).
/// Continuation: Periodic for Surround::Repeat, else Mirrored.
[[nodiscard]] HeightField print_layer(const GrayImage& image, const PrinterProfile& profile,
                                      const ProcessOptions& options);

/// The octaves of the printer's ground that rays may treat as geometry, and the rest.
///
/// An octave of RMS height σ with 4πσ/λ < 1 (normal incidence, where the phase is largest) leaves most
/// of the light where it was: it is kept out of the relief and its coherent loss is reported instead.
struct GroundSplit {
  std::vector<GroundOctave> geometric;
  std::vector<GroundOctave> coherent;
  double coherent_share = 1.0;  ///< e^(−Σ(4πσ/λ)²): light that the left-out octaves leave unscattered
};
[[nodiscard]] GroundSplit split_ground(const PrinterProfile& profile, Length wavelength);

/// Closed-form RMS height of one octave: amplitude·|weight|·√0.0219 (`noise_variance`).
[[nodiscard]] Length ground_rms_height(const PrinterProfile& profile, const GroundOctave& octave);

/// Adds amplitude · Σ weight · noise(p/scale) of the given octaves to a relief. `seed` is the printer's own
/// draw of the day. An octave's draw depends on the seed and its scale only: leaving others out changes nothing.
/// Missing samples stay missing.
void add_ground(HeightField& relief, const PrinterProfile& profile, const std::vector<GroundOctave>& octaves,
                std::uint64_t seed);

/// ∂z/∂x and ∂z/∂y of the same ground at single points: samples of a grid whose first one stands at `first`, drawn as
/// add_ground draws it from (0, 0) on.
/// Accuracy 3e-4 of an octave of 25 µm: central differences over 0.2 µm.
[[nodiscard]] ReliefSlopes ground_slopes(const Grid& grid, const Position& first, const PrinterProfile& profile,
                                         const std::vector<GroundOctave>& octaves, std::uint64_t seed);

/// Closed-form RMS slope of the given octaves along any axis: amplitude·√(Σ(w/scale)² · 0.8365/2).
[[nodiscard]] double ground_rms_slope(const PrinterProfile& profile, const std::vector<GroundOctave>& octaves);

/// How much of a slope of the given wavelength, along a pixel axis, survives pixel and blur:
/// sinc(p/λ)·exp(−2π²σ²/λ²), of a Lorentzian sinc(p/λ)·exp(−2πw/λ). Linear in light, so to first order in height.
[[nodiscard]] double pixel_transfer(const PrinterProfile& profile, Length wavelength);

}  // namespace mezzotint
