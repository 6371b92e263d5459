#include "measurement/correction/gaussian_filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "forward/base/error.h"
#include "forward/base/fft.h"

namespace mezzotint {

namespace {

constexpr double reach_in_cutoffs = 1.2;
constexpr std::size_t least_tile = 512;

using Complex = std::complex<double>;

/// One axis of the filter: its weights times (−x)^a, x the way from the sample, a = 0, 1, 2, as spectra.
struct Axis {
  std::size_t samples = 0, reach = 0, tile = 0, length = 0;
  std::array<std::vector<Complex>, 3> spectrum;

  Axis(std::size_t count, double cutoff_in_samples, bool periodic) : samples(count) {
    reach = static_cast<std::size_t>(std::ceil(reach_in_cutoffs * cutoff_in_samples));
    if (!periodic) reach = std::min(reach, count);
    tile = std::min(count, std::max(least_tile, 2 * reach));
    length = quick_fft_length(tile + 2 * reach);
    for (std::size_t a = 0; a < 3; ++a) spectrum[a] = moment_spectrum(a, cutoff_in_samples);
  }
  [[nodiscard]] std::size_t tiles() const { return (samples + tile - 1) / tile; }

private:
  [[nodiscard]] std::vector<Complex> moment_spectrum(std::size_t a, double cutoff) const {
    const double alpha = std::sqrt(std::numbers::ln2 / std::numbers::pi);
    double sum = 0.0;
    std::vector<double> weight(reach + 1);
    for (std::size_t i = 0; i <= reach; ++i) {
      const double x = static_cast<double>(i) / (alpha * cutoff);
      weight[i] = std::exp(-std::numbers::pi * x * x);
      sum += (i == 0 ? 1.0 : 2.0) * weight[i];
    }
    std::vector<Complex> values(length);
    for (std::size_t k = 0; k < length; ++k) {
      Complex value = a == 0 ? weight[0] : 0.0;
      for (std::size_t i = 1; i <= reach; ++i) {
        // The product of the numbers taken round the circle, so that the angle stays exact.
        const double angle = 2.0 * std::numbers::pi * static_cast<double>(i * k % length) / static_cast<double>(length);
        const double x = static_cast<double>(i);
        if (a == 1)
          value += Complex(0.0, 2.0 * x * weight[i] * std::sin(angle));
        else
          value += 2.0 * (a == 0 ? 1.0 : x * x) * weight[i] * std::cos(angle);
      }
      values[k] = value / sum;
    }
    return values;
  }
};

/// Weighted sums around each sample of a tile, with and without its heights.
class Tile {
public:
  Tile(const Axis& x, const Axis& y) : x_(x), y_(y), fft_(x.length, y.length) {}

  void filter(const HeightField& field, std::size_t tile_x, std::size_t tile_y, HeightField& result) {
    const std::size_t first_x = tile_x * x_.tile, first_y = tile_y * y_.tile;
    const std::size_t width = std::min(x_.tile, x_.samples - first_x), height = std::min(y_.tile, y_.samples - first_y);
    const bool whole = load(field, first_x, first_y);
    const std::vector<double> heights = moment(heights_, 0, 0);
    if (whole) {
      write(field, first_x, first_y, width, height, result, [&](std::size_t at) { return heights[at]; });
      return;
    }
    const auto w = [&](std::size_t a, std::size_t b) { return moment(weights_, a, b); };
    const std::vector<double> s00 = w(0, 0), s10 = w(1, 0), s01 = w(0, 1), s20 = w(2, 0), s11 = w(1, 1), s02 = w(0, 2);
    const std::vector<double> heights_x = moment(heights_, 1, 0), heights_y = moment(heights_, 0, 1);
    write(field, first_x, first_y, width, height, result, [&](std::size_t k) {
      // Cramer's rule for the height of the plane at the sample.
      const double c00 = s20[k] * s02[k] - s11[k] * s11[k], c10 = s10[k] * s02[k] - s01[k] * s11[k];
      const double c01 = s10[k] * s11[k] - s01[k] * s20[k];
      const double determinant = s00[k] * c00 - s10[k] * c10 + s01[k] * c01;
      // Too few samples for a plane: their mean.
      constexpr double rounding = 1e-9;
      if (!(determinant > rounding * s00[k] * s20[k] * s02[k])) return heights[k] / s00[k];
      return (heights[k] * c00 - heights_x[k] * c10 + heights_y[k] * c01) / determinant;
    });
  }

private:
  // Samples of the tile and all that its filter reaches. Whether every one of them is measured.
  bool load(const HeightField& field, std::size_t first_x, std::size_t first_y) {
    std::vector<std::ptrdiff_t> columns(x_.length), rows(y_.length);
    index(columns, first_x, x_, field.periodic());
    index(rows, first_y, y_, field.periodic());
    const std::size_t used_x = std::min(x_.length, x_.tile + 2 * x_.reach),
                      used_y = std::min(y_.length, y_.tile + 2 * y_.reach);
    bool whole = true;
    std::vector<double> weights(x_.length * y_.length, 0.0);
    std::ranges::fill(fft_.real(), 0.0);
    for (std::size_t r = 0; r < used_y; ++r) {
      for (std::size_t c = 0; c < used_x; ++c) {
        const bool inside = rows[r] >= 0 && columns[c] >= 0;
        const float z =
            inside ? field.at(static_cast<std::size_t>(columns[c]), static_cast<std::size_t>(rows[r])) : std::nanf("");
        if (std::isnan(z)) {
          whole = false;
          continue;
        }
        weights[r * x_.length + c] = 1.0;
        fft_.real()[r * x_.length + c] = static_cast<double>(z);
      }
    }
    transform(heights_);
    if (whole) return true;
    std::ranges::copy(weights, fft_.real().begin());
    transform(weights_);
    return false;
  }

  static void index(std::vector<std::ptrdiff_t>& places, std::size_t first, const Axis& axis, bool periodic) {
    const auto count = static_cast<std::ptrdiff_t>(axis.samples);
    for (std::size_t k = 0; k < places.size(); ++k) {
      const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(first + k) - static_cast<std::ptrdiff_t>(axis.reach);
      if (periodic)
        places[k] = (at % count + count) % count;
      else
        places[k] = at >= 0 && at < count ? at : -1;
    }
  }

  void transform(std::vector<Complex>& spectrum) {
    fft_.forward();
    spectrum.assign(fft_.spectrum().begin(), fft_.spectrum().end());
  }

  // Σ over the samples around each of weight · x^a y^b · what `of` is the spectrum of.
  std::vector<double> moment(const std::vector<Complex>& of, std::size_t a, std::size_t b) {
    const std::size_t columns = fft_.spectrum_columns();
    for (std::size_t ky = 0; ky < y_.length; ++ky) {
      const Complex factor = y_.spectrum[b][ky];
      for (std::size_t kx = 0; kx < columns; ++kx)
        fft_.spectrum()[ky * columns + kx] = of[ky * columns + kx] * factor * x_.spectrum[a][kx];
    }
    fft_.inverse();
    return {fft_.real().begin(), fft_.real().end()};
  }

  template <class Value>
  void write(const HeightField& field, std::size_t first_x, std::size_t first_y, std::size_t width, std::size_t height,
             HeightField& result, const Value& value) const {
    for (std::size_t r = 0; r < height; ++r)
      for (std::size_t c = 0; c < width; ++c) {
        if (std::isnan(field.at(first_x + c, first_y + r))) continue;
        result.at(first_x + c, first_y + r) = static_cast<float>(value((r + y_.reach) * x_.length + c + x_.reach));
      }
  }

  const Axis &x_, &y_;
  RealFft2d fft_;
  std::vector<Complex> heights_, weights_;
};

}  // namespace

HeightField s_filter(const HeightField& field, Length cutoff) {
  require(std::isfinite(cutoff.um()) && cutoff.um() > 0.0, "a filter needs a positive cut-off wavelength");
  const Grid& grid = field.grid();
  const bool periodic = field.periodic();
  require(!periodic || (cutoff.um() <= grid.pitch_x.um() * static_cast<double>(grid.columns) &&
                        cutoff.um() <= grid.pitch_y.um() * static_cast<double>(grid.rows)),
          "the cut-off wavelength is longer than the period of the field");
  // Far beyond the field a cut-off changes nothing any more: a plane is left.
  const auto in_samples = [&](Length pitch, std::size_t count) {
    return std::min(cutoff / pitch, 100.0 * static_cast<double>(count));
  };
  const Axis x(grid.columns, in_samples(grid.pitch_x, grid.columns), periodic);
  const Axis y(grid.rows, in_samples(grid.pitch_y, grid.rows), periodic);
  HeightField result = field;
  tbb::enumerable_thread_specific<Tile> tiles(x, y);
  tbb::parallel_for(std::size_t{0}, x.tiles() * y.tiles(),
                    [&](std::size_t tile) { tiles.local().filter(field, tile % x.tiles(), tile / x.tiles(), result); });
  return result;
}

HeightField l_filter(const HeightField& field, Length cutoff) {
  HeightField result = s_filter(field, cutoff);
  const auto heights_um = field.heights_um();
  const auto smooth_um = result.heights_um();
  for (std::size_t i = 0; i < heights_um.size(); ++i) smooth_um[i] = heights_um[i] - smooth_um[i];
  return result;
}

namespace {

// Of a wave as long as the cut-off, by the weights at whole samples alone.
double passed_at_cutoff(double cutoff_in_samples) {
  const double alpha = std::sqrt(std::numbers::ln2 / std::numbers::pi);
  double passed = 1.0, sum = 1.0;
  for (int k = 1; k <= std::ceil(reach_in_cutoffs * cutoff_in_samples); ++k) {
    const double x = k / (alpha * cutoff_in_samples), weight = 2.0 * std::exp(-std::numbers::pi * x * x);
    passed += weight * std::cos(2.0 * std::numbers::pi * k / cutoff_in_samples);
    sum += weight;
  }
  return passed / sum;
}

}  // namespace

std::string filter_warning(const HeightField& field, Length cutoff) {
  const Grid& grid = field.grid();
  const double spacing = std::max(grid.pitch_x.um(), grid.pitch_y.um());
  const double side = std::min(static_cast<double>(grid.columns) * grid.pitch_x.um(),
                               static_cast<double>(grid.rows) * grid.pitch_y.um());
  if (cutoff.um() > side)
    return fmt::format(
        "the cut-off of {:.4g} um is longer than the field ({:.4g} um): waves so long are not in it, and a plane is "
        "nearly all that is smoother",
        cutoff.um(), side);
  constexpr double most = 0.55, far = 10.0;
  const double samples = cutoff.um() / spacing, passed = samples > far ? 0.5 : passed_at_cutoff(samples);
  if (passed < most) return "";
  return fmt::format(
      "the cut-off of {:.4g} um is {:.2g} spacings: {:.0f} % of a wave that long passes, where half should; a filter "
      "needs a cut-off of four spacings",
      cutoff.um(), samples, 100.0 * passed);
}

}  // namespace mezzotint
