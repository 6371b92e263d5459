#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "forward/process/pixel_taps.h"
#include "forward/process/printed_relief.h"

/// Inside of forward/process.

namespace mezzotint {

/// What is wanted of the light: itself, or its derivative toward the width of the blur, or toward x or y; a pixel.
enum class LightPart { Value, WidthSlope, SlopeX, SlopeY };

/// Called with every finished row of samples, while it is still in the cache; in any order, by several threads.
using RowFinish = std::function<void(std::span<float>)>;

/// Pixels under a Gaussian, axis by axis.
///
/// Shape    an image is columns × rows pixels; samples are columns·subsamples × rows·subsamples.
/// Exact    for piecewise constant pixels, cut at 5σ and normalised.
class GaussianSpread {
public:
  GaussianSpread(std::size_t columns, std::size_t rows, double sigma_pixels, const ProcessOptions& options);

  /// @param finish  may be empty
  [[nodiscard]] GrayImage apply(const GrayImage& image, LightPart part, const RowFinish& finish) const;
  /// The transposed operator, from samples to pixels. (Of the width's slope there is none: nobody asks for it.)
  [[nodiscard]] GrayImage transposed(const GrayImage& samples, LightPart part) const;

private:
  using Wide = std::vector<float>;  // spread along the rows only
  using Taps = std::vector<PixelTaps>;
  [[nodiscard]] GrayImage spread(const GrayImage& image, const Taps& along_x, const Taps& along_y,
                                 const RowFinish& finish) const;
  [[nodiscard]] Wide widen(const GrayImage& image, const Taps& taps) const;
  void widen_row(const float* pixels, const Taps& taps, float* out) const;
  void sample_row(const Wide& wide, std::size_t row, const PixelTaps& taps, float* out) const;
  void narrow_row(const float* samples, const Taps& taps, float* pixels) const;
  [[nodiscard]] GrayImage gather_rows(const GrayImage& samples, const Taps& taps) const;
  [[nodiscard]] Taps taps_x(TapKind kind) const;
  [[nodiscard]] Taps taps_y(TapKind kind) const;

  std::size_t columns_, rows_, width_;
  double sigma_;
  ProcessOptions options_;
};

}  // namespace mezzotint
