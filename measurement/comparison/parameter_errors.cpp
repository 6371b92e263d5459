#include "measurement/comparison/parameter_errors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <vector>

#include "forward/base/fft.h"

namespace mezzotint {

namespace {

using Spectrum = std::vector<std::complex<double>>;

/// Residuals and slopes on the grid of the samples that were used, 0 where something is missing.
struct FitImages {
  std::size_t columns = 0;
  std::size_t rows = 0;
  std::vector<double> seen;
  std::vector<double> residual;
  std::array<std::vector<double>, FitParameterCount> slopes;
};

FitImages images_of(const Matching& matching, const Fit& fit) {
  FitImages images;
  images.columns = (matching.measured.columns() + matching.steps.x - 1) / matching.steps.x;
  images.rows = (matching.measured.rows() + matching.steps.y - 1) / matching.steps.y;
  const std::size_t size = images.columns * images.rows;
  images.seen.resize(size);
  images.residual.resize(size);
  for (auto& image : images.slopes) image.resize(size);
  for (std::size_t k = 0; k < size; ++k) {
    const SampleFit sample =
        sample_fit(matching, fit, k % images.columns * matching.steps.x, k / images.columns * matching.steps.y);
    if (std::isnan(sample.residual_um)) continue;
    images.seen[k] = 1.0;
    images.residual[k] = sample.residual_um;
    for (int p = 0; p < FitParameterCount; ++p) images.slopes[p][k] = sample.slopes[p];
  }
  return images;
}

Spectrum spectrum_of(RealFft2d& fft, const FitImages& images, const std::vector<double>& image) {
  std::fill(fft.real().begin(), fft.real().end(), 0.0);
  for (std::size_t k = 0; k < image.size(); ++k) {
    fft.real()[k / images.columns * fft.columns() + k % images.columns] = image[k];
  }
  fft.forward();
  return {fft.spectrum().begin(), fft.spectrum().end()};
}

std::vector<double> autocorrelated(RealFft2d& fft, const FitImages& images, const std::vector<double>& image) {
  const Spectrum spectrum = spectrum_of(fft, images, image);
  for (std::size_t k = 0; k < spectrum.size(); ++k) fft.spectrum()[k] = std::norm(spectrum[k]);
  fft.inverse();
  return {fft.real().begin(), fft.real().end()};
}

/// Mean product of residuals that lie a displacement apart, over the pairs where both are known.
std::vector<double> autocovariance(RealFft2d& fft, const FitImages& images) {
  std::vector<double> covariance = autocorrelated(fft, images, images.residual);
  const std::vector<double> pairs = autocorrelated(fft, images, images.seen);
  for (std::size_t k = 0; k < covariance.size(); ++k) covariance[k] = pairs[k] > 0.5 ? covariance[k] / pairs[k] : 0.0;
  return covariance;
}

/// Half the window along an axis: six times the displacement at which the residual's correlation has fallen to a
/// tenth; 8 samples at least, and no more than there is room for.
std::size_t window_reach(const std::vector<double>& covariance, std::size_t stride, std::size_t most) {
  std::size_t length = 1;
  while (6 * length < most && covariance[length * stride] > 0.1 * covariance[0]) ++length;
  return std::clamp<std::size_t>(6 * length, std::min<std::size_t>(8, most), most);
}

double hann(std::size_t index, std::size_t length, std::size_t reach) {
  const std::size_t displacement = std::min(index, length - index);
  if (displacement >= reach) return 0.0;
  return 0.5 + 0.5 * std::cos(std::numbers::pi * static_cast<double>(displacement) / static_cast<double>(reach));
}

/// Spectrum of the windowed autocovariance.
Spectrum residual_spectrum(RealFft2d& fft, const FitImages& images) {
  const std::vector<double> covariance = autocovariance(fft, images);
  const std::size_t reach_x = window_reach(covariance, 1, fft.columns() - images.columns);
  const std::size_t reach_y = window_reach(covariance, fft.columns(), fft.rows() - images.rows);
  for (std::size_t k = 0; k < covariance.size(); ++k) {
    fft.real()[k] =
        covariance[k] * hann(k % fft.columns(), fft.columns(), reach_x) * hann(k / fft.columns(), fft.rows(), reach_y);
  }
  fft.forward();
  return {fft.spectrum().begin(), fft.spectrum().end()};
}

/// B = Σ_kl J_k c(k − l) J_lᵀ.
FitMatrix correlated_products(const FitImages& images) {
  // The margin keeps displacements within the window from wrapping around: a quarter of the image is room for it.
  RealFft2d fft(quick_fft_length(images.columns + std::max<std::size_t>(8, images.columns / 4)),
                quick_fft_length(images.rows + std::max<std::size_t>(8, images.rows / 4)));
  const Spectrum noise = residual_spectrum(fft, images);
  std::array<Spectrum, FitParameterCount> slopes;
  for (int p = 0; p < FitParameterCount; ++p) slopes[p] = spectrum_of(fft, images, images.slopes[p]);
  FitMatrix products = FitMatrix::Zero();
  for (int a = 0; a < FitParameterCount; ++a) {
    for (int b = a; b < FitParameterCount; ++b) {
      double sum = 0.0;
      for (std::size_t k = 0; k < noise.size(); ++k) {
        const double product = (std::conj(slopes[a][k]) * slopes[b][k]).real();
        sum += fft.weight(k % fft.spectrum_columns()) * noise[k].real() * product;
      }
      products(a, b) = products(b, a) = sum / static_cast<double>(fft.columns() * fft.rows());
    }
  }
  return products;
}

}  // namespace

FitVector standard_errors(const Matching& matching, const Fit& fit) {
  const PartialInverse normal = invert_normal(fit.normal);
  const FitMatrix products = correlated_products(images_of(matching, fit));
  const FitVector variance = (normal.inverse * products * normal.inverse).diagonal();
  const FitVector white = fit.mean_square * normal.inverse.diagonal();
  FitVector errors;
  for (int p = 0; p < FitParameterCount; ++p) {
    // An estimated c need not be a covariance in every direction; a quarter of the textbook's variance is the
    // least that is believed.
    errors[p] = std::sqrt(std::max(variance[p], 0.25 * white[p]));
    if (normal.open[p] > 1e-6) errors[p] = std::numeric_limits<double>::infinity();
  }
  return errors;
}

}  // namespace mezzotint
