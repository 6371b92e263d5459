#pragma once

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

#include "forward/base/fft.h"
#include "forward/process/gaussian_spread.h"
#include "forward/process/lorentzian_kernel.h"
#include "forward/process/printed_relief.h"

/// Inside of forward/process.

namespace mezzotint {

/// Pixels under a bivariate Lorentzian, whose tails reach over the whole patch: by FFT, one for every sub-pixel
/// position.
///
/// Shape    as GaussianSpread.
/// Exact    for piecewise constant pixels (integrals in closed form) in the dark. Under repetition or mirrors the
///          copies beyond the nearest ones shine as if they were smeared out, which is right to 1e-6 of the light.
/// Memory   the kernels' spectra are kept where they take less than 256 MiB, else made anew at each use.
class LorentzianSpread {
public:
  /// @throws InvalidInput for a side of more than 32768 pixels.
  LorentzianSpread(std::size_t columns, std::size_t rows, double width_pixels, const ProcessOptions& options);

  [[nodiscard]] GrayImage apply(const GrayImage& image, LightPart part, const RowFinish& finish) const;
  [[nodiscard]] GrayImage transposed(const GrayImage& samples, LightPart part) const;

private:
  using Spectrum = std::vector<std::complex<double>>;

  [[nodiscard]] RealFft2d plane() const { return RealFft2d(plane_columns_, plane_rows_); }
  [[nodiscard]] std::size_t phases() const { return options_.subsamples * options_.subsamples; }
  [[nodiscard]] Spectrum image_spectrum(const GrayImage& image) const;
  [[nodiscard]] Spectrum kernel_spectrum(std::size_t phase, LightPart part) const;
  [[nodiscard]] GrayImage folded(std::span<const double> plane) const;

  std::size_t columns_, rows_;
  std::size_t plane_columns_, plane_rows_;
  double width_;
  ProcessOptions options_;
  std::vector<Spectrum> kept_;
};

}  // namespace mezzotint
