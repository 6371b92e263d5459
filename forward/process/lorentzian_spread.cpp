#include "forward/process/lorentzian_spread.h"

#include <algorithm>
#include <cstdint>

#include <tbb/parallel_for.h>

#include "forward/base/error.h"
#include "forward/process/surrounding_pixel.h"

namespace mezzotint {

namespace {

constexpr std::size_t largest_side = 32768;
constexpr std::size_t most_kept_bytes = std::size_t{256} << 20;

// The plane on which a convolution round its ends is the one that is meant.
std::size_t plane_side(std::size_t pixels, Surround surround) {
  require(pixels <= largest_side, "under a Lorentzian blur an image has at most 32768 pixels a side");
  if (surround == Surround::Repeat) return pixels;
  return surround == Surround::Mirror ? 2 * pixels : quick_fft_length(2 * pixels);
}

}  // namespace

LorentzianSpread::LorentzianSpread(std::size_t columns, std::size_t rows, double width_pixels,
                                   const ProcessOptions& options)
    : columns_(columns),
      rows_(rows),
      plane_columns_(plane_side(columns, options.surround)),
      plane_rows_(plane_side(rows, options.surround)),
      width_(width_pixels),
      options_(options) {
  const std::size_t bytes = phases() * plane_rows_ * (plane_columns_ / 2 + 1) * sizeof(std::complex<double>);
  if (bytes > most_kept_bytes) return;
  std::vector<Spectrum> spectra(phases());
  tbb::parallel_for(std::size_t{0}, phases(),
                    [&](std::size_t phase) { spectra[phase] = kernel_spectrum(phase, LightPart::Value); });
  kept_ = std::move(spectra);
}

LorentzianSpread::Spectrum LorentzianSpread::image_spectrum(const GrayImage& image) const {
  RealFft2d fft = plane();
  for (std::size_t row = 0; row < plane_rows_; ++row) {
    const auto from = pixel_at(static_cast<std::int64_t>(row), rows_, options_.surround);
    if (!from) continue;
    for (std::size_t column = 0; column < plane_columns_; ++column) {
      const auto pixel = pixel_at(static_cast<std::int64_t>(column), columns_, options_.surround);
      if (pixel) fft.real()[row * plane_columns_ + column] = static_cast<double>(image.at(*pixel, *from));
    }
  }
  fft.forward();
  return {fft.spectrum().begin(), fft.spectrum().end()};
}

LorentzianSpread::Spectrum LorentzianSpread::kernel_spectrum(std::size_t phase, LightPart part) const {
  if (part == LightPart::Value && !kept_.empty()) return kept_[phase];
  const auto place = [this](std::size_t sub_pixel, double within) {
    return (static_cast<double>(sub_pixel) + within) / static_cast<double>(options_.subsamples);
  };
  const std::size_t sub_row = phase / options_.subsamples, sub_column = phase % options_.subsamples;
  const WeightPlane seen{plane_columns_, plane_rows_, place(sub_column, options_.place_x),
                         place(sub_row, options_.place_y), options_.surround != Surround::Dark};
  const std::vector<double> weights = lorentzian_weights({width_}, part, seen);
  RealFft2d fft = plane();
  std::ranges::copy(weights, fft.real().begin());
  fft.forward();
  return {fft.spectrum().begin(), fft.spectrum().end()};
}

// A sample sees the pixels around it: a correlation with the weights.
GrayImage LorentzianSpread::apply(const GrayImage& image, LightPart part, const RowFinish& finish) const {
  const std::size_t n = options_.subsamples;
  GrayImage light{columns_ * n, rows_ * n, {}};
  light.values.resize(light.columns * light.rows);
  const Spectrum pixels = image_spectrum(image);
  tbb::parallel_for(std::size_t{0}, phases(), [&](std::size_t phase) {
    const Spectrum kernel = kernel_spectrum(phase, part);
    RealFft2d fft = plane();
    for (std::size_t k = 0; k < kernel.size(); ++k) fft.spectrum()[k] = std::conj(kernel[k]) * pixels[k];
    fft.inverse();
    for (std::size_t row = 0; row < rows_; ++row) {
      float* const out = light.values.data() + (row * n + phase / n) * light.columns + phase % n;
      const double* const in = fft.real().data() + row * plane_columns_;
      for (std::size_t column = 0; column < columns_; ++column) out[column * n] = static_cast<float>(in[column]);
    }
  });
  if (!finish) return light;
  tbb::parallel_for(std::size_t{0}, light.rows, [&](std::size_t row) {
    finish({light.values.data() + row * light.columns, light.columns});
  });
  return light;
}

// Phase after phase, so that the sum has one order.
GrayImage LorentzianSpread::transposed(const GrayImage& samples, LightPart part) const {
  const std::size_t n = options_.subsamples;
  RealFft2d fft = plane();
  Spectrum sum(fft.spectrum().size());
  for (std::size_t phase = 0; phase < phases(); ++phase) {
    std::ranges::fill(fft.real(), 0.0);
    for (std::size_t row = 0; row < rows_; ++row) {
      const float* const in = samples.values.data() + (row * n + phase / n) * samples.columns + phase % n;
      double* const out = fft.real().data() + row * plane_columns_;
      for (std::size_t column = 0; column < columns_; ++column) out[column] = static_cast<double>(in[column * n]);
    }
    fft.forward();
    const Spectrum kernel = kernel_spectrum(phase, part);
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += kernel[k] * fft.spectrum()[k];
  }
  std::ranges::copy(sum, fft.spectrum().begin());
  fft.inverse();
  return folded(fft.real());
}

// What arrived in the surround belongs to the pixels that it shows.
GrayImage LorentzianSpread::folded(std::span<const double> plane) const {
  std::vector<double> sums(columns_ * rows_, 0.0);
  for (std::size_t row = 0; row < plane_rows_; ++row) {
    const auto to = pixel_at(static_cast<std::int64_t>(row), rows_, options_.surround);
    if (!to) continue;
    for (std::size_t column = 0; column < plane_columns_; ++column) {
      const auto pixel = pixel_at(static_cast<std::int64_t>(column), columns_, options_.surround);
      if (pixel) sums[*to * columns_ + *pixel] += plane[row * plane_columns_ + column];
    }
  }
  return {columns_, rows_, {sums.begin(), sums.end()}};
}

}  // namespace mezzotint
