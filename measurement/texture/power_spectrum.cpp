#include "measurement/texture/power_spectrum.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>

#include "forward/base/error.h"
#include "measurement/texture/row_spectra.h"

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

// Row by row, each weighted as a whole, so that the rounding of long sums stays small.
double weighted_mean_um(const HeightField& field, const std::vector<double>& window_x,
                        const std::vector<double>& window_y) {
  std::vector<double> rows(field.rows());
  tbb::parallel_for(std::size_t{0}, field.rows(), [&](std::size_t row) {
    constexpr std::size_t lanes = 8;
    double sums[lanes] = {};
    const auto heights_um = field.heights_um().subspan(row * field.columns(), field.columns());
    for (std::size_t c = 0; c < heights_um.size(); ++c)
      sums[c % lanes] += window_x[c] * static_cast<double>(heights_um[c]);
    rows[row] = window_y[row] * std::accumulate(std::begin(sums), std::end(sums), 0.0);
  });
  const auto total = [](const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
  };
  return total(rows) / (total(window_x) * total(window_y));
}

}  // namespace

PowerSpectrum power_spectrum(const HeightField& field) {
  const std::size_t columns = field.columns(), rows = field.rows();
  require(columns >= 4 && rows >= 4, "a power spectrum needs 4 x 4 samples at least");
  require(field.missing_count() == 0, "a power spectrum needs every sample; fill the missing ones first");
  const std::vector<double> window_x = hann(columns, field.periodic()), window_y = hann(rows, field.periodic());
  const double mean = weighted_mean_um(field, window_x, window_y);
  RowSpectra spectra(rows, columns, [&](std::size_t row, std::span<double> line) {
    const auto heights_um = field.heights_um().subspan(row * columns, columns);
    for (std::size_t c = 0; c < columns; ++c)
      line[c] = window_x[c] * window_y[row] * (static_cast<double>(heights_um[c]) - mean);
  });
  PowerSpectrum result{columns, rows, field.grid().pitch_x, field.grid().pitch_y, std::vector<double>(columns * rows)};
  // |F|² · area of a sample ÷ Σ w².
  const double scale =
      field.grid().pitch_x.um() * field.grid().pitch_y.um() / (sum_of_squares(window_x) * sum_of_squares(window_y));
  spectra.for_each_four_columns(rows, [&](std::size_t first, std::span<ComplexFftLine> lines, RealFftLine&) {
    for (std::size_t ky = 0; ky < rows; ++ky) {
      double* above = result.density_um4.data() + (ky + rows / 2) % rows * columns;
      double* below = result.density_um4.data() + (rows - ky + rows / 2) % rows * columns;
      for (std::size_t k = 0; k < lines.size(); ++k) {
        const std::size_t kx = first + k;
        const double density = scale * std::norm(lines[k].values()[ky]);
        above[(kx + columns / 2) % columns] = density;
        if (kx != 0 && 2 * kx != columns) below[(columns - kx + columns / 2) % columns] = density;
      }
    }
    return std::size_t{0};
  });
  return result;
}

RadialSpectrum radial_spectrum(const PowerSpectrum& spectrum) {
  const double length = std::max(static_cast<double>(spectrum.columns) * spectrum.pitch_x.um(),
                                 static_cast<double>(spectrum.rows) * spectrum.pitch_y.um());
  const double step = 1.0 / length;
  struct Ring {
    double count = 0.0, frequency = 0.0, sum = 0.0, squares = 0.0;
  };
  std::vector<Ring> rings;
  for (std::size_t row = 0; row < spectrum.rows; ++row)
    for (std::size_t column = 0; column < spectrum.columns; ++column) {
      const double f = std::hypot(spectrum.frequency_x_per_um(column), spectrum.frequency_y_per_um(row));
      const auto ring = static_cast<std::size_t>(std::lround(f / step));
      if (ring == 0) continue;
      if (ring >= rings.size() + 1) rings.resize(ring);
      const double density = spectrum.density_um4[row * spectrum.columns + column];
      Ring& at = rings[ring - 1];
      at.count += 1.0;
      at.frequency += f;
      at.sum += density;
      at.squares += density * density;
    }
  RadialSpectrum result;
  for (const Ring& ring : rings) {
    if (ring.count == 0.0) continue;
    const double mean = ring.sum / ring.count, independent = std::max(1.0, 0.5 * ring.count);
    const double variance = std::max(0.0, ring.squares / ring.count - mean * mean);
    result.frequency_per_um.push_back(ring.frequency / ring.count);
    result.density_um4.push_back(mean);
    // A pair alone has no scatter of its own: its mean is its deviation.
    result.standard_error_um4.push_back(ring.count > 2.0 ? std::sqrt(variance / std::max(1.0, independent - 1.0))
                                                         : mean);
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
