#pragma once

#include <cstddef>
#include <vector>

#include "forward/surface/height_field.h"

/// Inside of measurement/correction: what the two ways of filtering share.

namespace mezzotint {

/// Weights of a Gaussian filter along one axis, at 0 … reach samples from the middle; they sum to 1 over both sides.
struct GaussianWindow {
  std::size_t samples = 0, reach = 0;
  std::vector<double> weights;

  GaussianWindow(std::size_t count, double cutoff_in_samples, bool periodic);
};

/// Σ over the measured samples around one of weight · x^a y^b, and of that times the height (hx, hy: times x, y too); x
/// and y are the ways from the sample.
struct LocalMoments {
  double s00, s10, s01, s20, s11, s02, h, hx, hy;

  /// The height of the weighted least-squares plane at the sample, by Cramer's rule.
  [[nodiscard]] double plane_height() const {
    const double c00 = s20 * s02 - s11 * s11, c10 = s10 * s02 - s01 * s11, c01 = s10 * s11 - s01 * s20;
    const double determinant = s00 * c00 - s10 * c10 + s01 * c01;
    // Too few samples for a plane: their mean.
    constexpr double rounding = 1e-9;
    if (!(determinant > rounding * s00 * s20 * s02)) return h / s00;
    return (h * c00 - hx * c10 + hy * c01) / determinant;
  }
};

/// Where the samples of a tile, and `reach` around it, are: places[k] of first − reach + k, of so many samples along
/// the axis; −1 beyond the end of a patch.
[[nodiscard]] std::vector<std::ptrdiff_t> places_around(std::size_t first, std::size_t tile, std::size_t samples,
                                                        std::size_t reach, bool periodic);

/// By sums over the weights themselves: the quicker way for windows of up to `longest_direct_reach`.
[[nodiscard]] HeightField filter_directly(const HeightField& field, const GaussianWindow& x, const GaussianWindow& y);
inline constexpr std::size_t longest_direct_reach = 128;

/// By Fourier transforms of tiles.
[[nodiscard]] HeightField filter_by_fft(const HeightField& field, const GaussianWindow& x, const GaussianWindow& y);

}  // namespace mezzotint
