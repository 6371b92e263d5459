#include "measurement/comparison/masked_correlation.h"

#include <algorithm>
#include <cmath>

#include "forward/base/fft.h"

namespace mezzotint {

namespace {

using Spectrum = std::vector<std::complex<double>>;

std::vector<double> squares_of(std::vector<double> values) {
  for (double& value : values) value *= value;
  return values;
}

Spectrum spectrum_of(RealFft2d& fft, const MaskedImage& image, const std::vector<double>& values) {
  std::fill(fft.real().begin(), fft.real().end(), 0.0);
  for (std::size_t r = 0; r < image.rows; ++r) {
    const auto row = values.begin() + static_cast<std::ptrdiff_t>(r * image.columns);
    std::copy_n(row, image.columns, fft.real().begin() + static_cast<std::ptrdiff_t>(r * fft.columns()));
  }
  fft.forward();
  return {fft.spectrum().begin(), fft.spectrum().end()};
}

/// Σ_n a(n) b(n + k) for every k.
std::vector<double> correlate(RealFft2d& fft, const Spectrum& a, const Spectrum& b) {
  for (std::size_t k = 0; k < a.size(); ++k) fft.spectrum()[k] = std::conj(a[k]) * b[k];
  fft.inverse();
  return {fft.real().begin(), fft.real().end()};
}

/// The sums over the samples that both images know, for every displacement.
struct PairSums {
  std::vector<double> count, f, g, ff, gg, fg;
};

double pearson(const PairSums& sums, std::size_t k) {
  const double n = sums.count[k];
  const double ff = sums.ff[k] - sums.f[k] * sums.f[k] / n;
  const double gg = sums.gg[k] - sums.g[k] * sums.g[k] / n;
  // Heights are of order 1, and round-off of the transforms about 1e-15 of the sums: below this share of its
  // mean square an image is flat as far as one can tell.
  constexpr double flat = 1e-9;
  if (ff < flat * n || gg < flat * n) return 0.0;
  return std::clamp((sums.fg[k] - sums.f[k] * sums.g[k] / n) / std::sqrt(ff * gg), -1.0, 1.0);
}

}  // namespace

MaskedCorrelation::MaskedCorrelation(const MaskedImage& fixed, std::size_t columns, std::size_t rows)
    : columns_(quick_fft_length(fixed.columns + columns)),
      rows_(quick_fft_length(fixed.rows + rows)),
      fixed_columns_(fixed.columns),
      fixed_rows_(fixed.rows) {
  RealFft2d fft(columns_, rows_);
  seen_ = spectrum_of(fft, fixed, fixed.seen);
  values_ = spectrum_of(fft, fixed, fixed.values);
  squares_ = spectrum_of(fft, fixed, squares_of(fixed.values));
}

CorrelationMap MaskedCorrelation::with(const MaskedImage& moving, double least_overlap) const {
  RealFft2d fft(columns_, rows_);
  const Spectrum seen = spectrum_of(fft, moving, moving.seen);
  const Spectrum values = spectrum_of(fft, moving, moving.values);
  const Spectrum squares = spectrum_of(fft, moving, squares_of(moving.values));
  PairSums sums;
  sums.count = correlate(fft, seen, seen_);
  sums.f = correlate(fft, values, seen_);
  sums.g = correlate(fft, seen, values_);
  sums.ff = correlate(fft, squares, seen_);
  sums.gg = correlate(fft, seen, squares_);
  sums.fg = correlate(fft, values, values_);
  CorrelationMap map{columns_, rows_, fixed_columns_, fixed_rows_, {}, {}};
  map.correlation.resize(columns_ * rows_);
  map.overlap.resize(columns_ * rows_);
  const double least = std::max(3.0, least_overlap) - 0.5;  // counts are whole but for round-off
  for (std::size_t k = 0; k < map.correlation.size(); ++k) {
    map.overlap[k] = std::max(0.0, std::round(sums.count[k]));
    if (sums.count[k] >= least) map.correlation[k] = pearson(sums, k);
  }
  return map;
}

}  // namespace mezzotint
