#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "forward/process/pixel_taps.h"
#include "forward/process/printed_relief.h"

/// Inside of forward/process.

namespace mezzotint {

/// Called with every finished row of samples, while it is still in the cache; in any order, by several threads.
using RowFinish = std::function<void(std::span<float>)>;

/// Pixels under a Gaussian, axis by axis.
///
/// Shape    an image is columns × rows pixels; samples are columns·subsamples × rows·subsamples.
/// Exact    for piecewise constant pixels, cut at 5σ and normalised.
class GaussianSpread {
public:
  GaussianSpread(std::size_t columns, std::size_t rows, double sigma_pixels, const ProcessOptions& options);

  [[nodiscard]] GrayImage apply(const GrayImage& image, const RowFinish& finish) const;
  /// d apply / dσ, a pixel of σ.
  [[nodiscard]] GrayImage apply_width_slope(const GrayImage& image) const;
  /// The transposed operator: from samples to pixels.
  [[nodiscard]] GrayImage transposed(const GrayImage& samples) const;

private:
  using Wide = std::vector<float>;  // spread along the rows only
  [[nodiscard]] Wide widen(const GrayImage& image, const std::vector<PixelTaps>& taps) const;
  void widen_row(const float* pixels, const std::vector<PixelTaps>& taps, float* out) const;
  void sample_row(const Wide& wide, std::size_t row, const PixelTaps& taps, float* out) const;
  [[nodiscard]] GrayImage gather_rows(const GrayImage& samples) const;

  std::size_t columns_, rows_, width_;
  ProcessOptions options_;
  std::vector<PixelTaps> taps_, slopes_;
};

}  // namespace mezzotint
