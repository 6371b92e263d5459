#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "forward/pattern/pattern_derivatives.h"
#include "forward/process/print_process.h"
#include "forward/process/printer_profile.h"

namespace mezzotint {

/// Whether gray values are real numbers (smooth, for a search) or the printer's levels (as printed).
enum class GrayLevels { Continuous, Quantized };

/// The patch in which textures are judged.
struct PatchOptions {
  std::size_t pixels = 192;                    ///< a side, of the projector
  std::size_t subsamples = 4;                  ///< samples of the relief a pixel and axis
  Length wavelength = Length::from_nm(550.0);  ///< decides which octaves of the ground are geometry
};

/// Heights of a pattern at the centres of a patch's pixels, lifted to the top of what one layer reaches: there
/// the gray levels are finest, and the dark threshold is far.
[[nodiscard]] HeightField pixel_heights(const PatternInstance& instance, const PrinterProfile& printer,
                                        std::size_t pixels);

/// The same with derivatives toward some of the pattern's numbers, the lift's included.
[[nodiscard]] HeightDerivatives pixel_heights_with_derivatives(const PatternInstance& instance,
                                                               const PrinterProfile& printer, std::size_t pixels,
                                                               std::span<const std::string> names);

/// A texture as it comes out of a printer: pattern → gray → light → cure height → ground noise.
///
/// The random parts (draw of the pattern, ground noise) follow from the seed alone, so two parameter values
/// meet the same surface: common random numbers.
class PrintedTexture {
public:
  /// The ground noise of every seed is made once, here.
  PrintedTexture(const PrinterProfile& printer, const PatchOptions& patch, std::vector<std::uint64_t> seeds);

  [[nodiscard]] const std::vector<std::uint64_t>& seeds() const { return seeds_; }

  /// The relief of the i-th seed.
  [[nodiscard]] HeightField print(const Pattern& pattern, std::size_t seed_index, GrayLevels levels) const;

  /// Slope covariances of all seeds, in their order.
  [[nodiscard]] std::vector<SlopeCovariance> slope_covariances(const Pattern& pattern, GrayLevels levels) const;

private:
  PrinterProfile printer_;
  PatchOptions patch_;
  PrintProcess process_;
  std::vector<std::uint64_t> seeds_;
  std::vector<HeightField> grounds_;
};

/// Mean of slope covariances and the standard error of each moment over independent draws.
struct MeanCovariance {
  SlopeCovariance mean;
  SlopeCovariance standard_error;
};
/// @throws InvalidInput for an empty list; with one draw the standard errors are NaN.
[[nodiscard]] MeanCovariance mean_of(const std::vector<SlopeCovariance>& draws);

/// Principal RMS slopes of a mean covariance with their standard errors (delete-one jackknife over the draws).
struct SlopeAxesEstimate {
  SlopeAxes axes;
  double rms_major_error = 0.0;
  double rms_minor_error = 0.0;
  Angle rotation_error;
};
[[nodiscard]] SlopeAxesEstimate estimate_axes(const std::vector<SlopeCovariance>& draws);

}  // namespace mezzotint
