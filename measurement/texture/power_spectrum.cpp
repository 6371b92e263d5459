#include "measurement/texture/power_spectrum.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "forward/base/error.h"
#include "forward/base/fft.h"

namespace mezzotint {

namespace {

std::vector<double> hann(std::size_t count, bool periodic) {
  std::vector<double> window(count, 1.0);
  if (periodic) return window;
  for (std::size_t k = 0; k < count; ++k)
    window[k] =
        0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * (static_cast<double>(k) + 0.5) / static_cast<double>(count));
  return window;
}

double sum_of_squares(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return sum;
}

}  // namespace

PowerSpectrum power_spectrum(const HeightField& field) {
  const std::size_t columns = field.columns(), rows = field.rows();
  require(columns >= 4 && rows >= 4, "a power spectrum needs 4 x 4 samples at least");
  require(field.missing_count() == 0, "a power spectrum needs every sample; fill the missing ones first");
  const std::vector<double> window_x = hann(columns, field.periodic()), window_y = hann(rows, field.periodic());
  double mean = 0.0, weight = 0.0;
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t column = 0; column < columns; ++column) {
      const double w = window_x[column] * window_y[row];
      mean += w * static_cast<double>(field.at(column, row));
      weight += w;
    }
  mean /= weight;
  RealFft2d fft(columns, rows);
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t column = 0; column < columns; ++column)
      fft.real()[row * columns + column] =
          window_x[column] * window_y[row] * (static_cast<double>(field.at(column, row)) - mean);
  fft.forward();
  PowerSpectrum result{columns, rows, field.grid().pitch_x, field.grid().pitch_y, std::vector<double>(columns * rows)};
  // |F|² · area of a sample ÷ Σ w².
  const double scale =
      field.grid().pitch_x.um() * field.grid().pitch_y.um() / (sum_of_squares(window_x) * sum_of_squares(window_y));
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t column = 0; column < columns; ++column) {
      std::size_t kx = (column + columns - columns / 2) % columns, ky = (row + rows - rows / 2) % rows;
      if (kx >= fft.spectrum_columns()) {
        kx = columns - kx;
        ky = (rows - ky) % rows;
      }
      result.density_um4[row * columns + column] = scale * std::norm(fft.spectrum()[ky * fft.spectrum_columns() + kx]);
    }
  return result;
}

AngularSpectrum angular_spectrum(const PowerSpectrum& spectrum, double least_per_um, std::size_t directions) {
  require(directions >= 2 && directions <= 3600, "an angular spectrum has 2 to 3600 directions");
  AngularSpectrum result{std::vector<double>(directions, 0.0)};
  double total = 0.0;
  const double step = std::numbers::pi / static_cast<double>(directions);
  for (std::size_t row = 0; row < spectrum.rows; ++row)
    for (std::size_t column = 0; column < spectrum.columns; ++column) {
      const double fx = spectrum.frequency_x_per_um(column), fy = spectrum.frequency_y_per_um(row);
      if ((fx == 0.0 && fy == 0.0) || std::hypot(fx, fy) < least_per_um) continue;
      const double angle = std::atan2(fy, fx) + 2.0 * std::numbers::pi;
      const auto direction = static_cast<std::size_t>(std::llround(angle / step)) % directions;
      const double density = spectrum.density_um4[row * spectrum.columns + column];
      result.share[direction] += density;
      total += density;
    }
  require(total > 0.0, "a flat field has no directions");
  for (double& share : result.share) share /= total;
  return result;
}

}  // namespace mezzotint
