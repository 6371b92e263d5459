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
  PowerSpectrum result{
      columns,          rows, field.grid().pitch_x, field.grid().pitch_y, std::vector<double>(columns * rows),
      !field.periodic()};
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
  // Hann's window joins a frequency with its neighbours, by 2/3 and 1/6 of its amplitude along each axis. The sum of
  // the squares of these over the neighbours in the same ring, one step wide, averaged over its directions.
  const double joined = spectrum.windowed ? 1.865 : 1.0;
  RadialSpectrum result;
  for (const Ring& ring : rings) {
    if (ring.count == 0.0) continue;
    const double mean = ring.sum / ring.count, independent = std::max(1.0, 0.5 * ring.count / joined);
    const double variance = std::max(0.0, ring.squares / ring.count - mean * mean);
    result.frequency_per_um.push_back(ring.frequency / ring.count);
    result.density_um4.push_back(mean);
    // A pair alone has no scatter of its own: its mean is its deviation.
    result.standard_error_um4.push_back(ring.count > 2.0 ? std::sqrt(variance / std::max(1.0, independent - 1.0))
                                                         : mean);
  }
  return result;
}

namespace {

// visit(f_x, f_y, density) for every frequency within the limits; 0 belongs to no direction.
template <class Visit>
void for_each_within(const PowerSpectrum& spectrum, const AngularLimits& limits, const Visit& visit) {
  for (std::size_t row = 0; row < spectrum.rows; ++row)
    for (std::size_t column = 0; column < spectrum.columns; ++column) {
      const double fx = spectrum.frequency_x_per_um(column), fy = spectrum.frequency_y_per_um(row);
      const double f = std::hypot(fx, fy);
      if (f == 0.0 || f < limits.least_per_um || f > limits.most_per_um) continue;
      visit(fx, fy, spectrum.density_um4[row * spectrum.columns + column]);
    }
}

double power_within(const PowerSpectrum& spectrum, const AngularLimits& limits) {
  double power = 0.0;
  for_each_within(spectrum, limits, [&](double, double, double density) { power += density; });
  return power;
}

}  // namespace

namespace {

// The part of a tent of half-width 1 that lies before x.
double tent_before(double x) {
  if (x <= -1.0) return 0.0;
  if (x >= 1.0) return 1.0;
  return x < 0.0 ? 0.5 * (1.0 + x) * (1.0 + x) : 1.0 - 0.5 * (1.0 - x) * (1.0 - x);
}

// Adds power at an angle, in steps, to the directions around by a tent of that half-width: as wide as a cell of the
// spectrum is, seen from its middle.
void add_tent(std::vector<double>& share, double angle, double half_width, double power) {
  const auto directions = static_cast<std::ptrdiff_t>(share.size());
  const auto first = static_cast<std::ptrdiff_t>(std::floor(angle - half_width + 0.5));
  const auto last = static_cast<std::ptrdiff_t>(std::floor(angle + half_width + 0.5));
  double before = 0.0;
  for (std::ptrdiff_t k = first; k <= last; ++k) {
    const double up_to = k == last ? 1.0 : tent_before((static_cast<double>(k) + 0.5 - angle) / half_width);
    share[static_cast<std::size_t>((k % directions + directions) % directions)] += power * (up_to - before);
    before = up_to;
  }
}

/// A frequency, and how far its neighbours are.
struct SpectrumCell {
  double fx, fy, cell_x, cell_y;
};

constexpr double near_cells = 16.0;  // nearer to the middle a cell is no narrow angle

double half_width(double fx, double fy, double cell_x, double cell_y) {
  // So wide the tents of a lattice's lines add up to the same in every direction: along an axis lines are one cell
  // apart, along a diagonal 1/√2.
  return std::min(0.5 * std::numbers::pi, (std::abs(fy) * cell_x + std::abs(fx) * cell_y) / (fx * fx + fy * fy));
}

// The same for a frequency near the middle: by the directions of the places where it counts, were the spectrum
// interpolated bilinearly, each as wide as a place is.
void add_cell(std::vector<double>& share, const SpectrumCell& cell, double step, double power) {
  // Each way; fewer where they are further from the middle. One of them is the frequency itself, none the middle.
  const double cells = std::hypot(cell.fx / cell.cell_x, cell.fy / cell.cell_y);
  const int places = std::clamp(static_cast<int>(std::ceil(32.0 / cells)), 2, 8);
  const double sum = static_cast<double>(places) * places;
  for (int i = 1 - places; i < places; ++i)
    for (int j = 1 - places; j < places; ++j) {
      const double u = static_cast<double>(i) / places, v = static_cast<double>(j) / places;
      const double fx = cell.fx + u * cell.cell_x, fy = cell.fy + v * cell.cell_y;
      add_tent(share, std::atan2(fy, fx) / step, half_width(fx, fy, cell.cell_x / places, cell.cell_y / places) / step,
               power * (1.0 - std::abs(u)) * (1.0 - std::abs(v)) / sum);
    }
}

}  // namespace

AngularSpectrum angular_spectrum(const PowerSpectrum& spectrum, const AngularLimits& limits, std::size_t directions) {
  require(directions >= 2 && directions <= 3600, "an angular spectrum has 2 to 3600 directions");
  AngularSpectrum result{std::vector<double>(directions, 0.0)};
  double total = 0.0;
  const double step = std::numbers::pi / static_cast<double>(directions);
  const double cell_x = 1.0 / (static_cast<double>(spectrum.columns) * spectrum.pitch_x.um());
  const double cell_y = 1.0 / (static_cast<double>(spectrum.rows) * spectrum.pitch_y.um());
  const double near = near_cells * std::max(cell_x, cell_y);
  for_each_within(spectrum, limits, [&](double fx, double fy, double density) {
    total += density;
    // Of a long and narrow field no further than the frequency is from the middle, lest it count in any direction.
    const double f = std::hypot(fx, fy);
    if (f < near) return add_cell(result.share, {fx, fy, std::min(f, cell_x), std::min(f, cell_y)}, step, density);
    add_tent(result.share, std::atan2(fy, fx) / step, half_width(fx, fy, cell_x, cell_y) / step, density);
  });
  require(total > 0.0, "no power within these frequencies: a flat field has no directions");
  for (double& share : result.share) share /= total;
  return result;
}

double angular_power_share(const PowerSpectrum& spectrum, const AngularLimits& limits) {
  const double all = power_within(spectrum, {});
  return all > 0.0 ? power_within(spectrum, limits) / all : 0.0;
}

}  // namespace mezzotint
