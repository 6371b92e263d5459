#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "forward/base/fft.h"
#include "measurement/correction/gaussian_window.h"

namespace mezzotint {

namespace {

constexpr std::size_t least_tile = 512;

using Complex = std::complex<double>;

/// One axis of the filter: its weights times (−x)^a, x the way from the sample, a = 0, 1, 2, as spectra.
struct Axis {
  std::size_t samples = 0, reach = 0, tile = 0, length = 0;
  std::array<std::vector<Complex>, 3> spectrum;

  explicit Axis(const GaussianWindow& window)
      : samples(window.samples),
        reach(window.reach),
        tile(std::min(samples, std::max(least_tile, 2 * reach))),
        length(quick_fft_length(tile + 2 * reach)) {
    for (std::size_t a = 0; a < 3; ++a) spectrum[a] = moment_spectrum(a, window.weights);
  }
  [[nodiscard]] std::size_t tiles() const { return (samples + tile - 1) / tile; }

private:
  [[nodiscard]] std::vector<Complex> moment_spectrum(std::size_t a, const std::vector<double>& weight) const {
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
      values[k] = value;
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
      const LocalMoments m{s00[k], s10[k], s01[k], s20[k], s11[k], s02[k], heights[k], heights_x[k], heights_y[k]};
      return m.plane_height();
    });
  }

private:
  // Samples of the tile and all that its filter reaches. Whether every one of them is measured.
  bool load(const HeightField& field, std::size_t first_x, std::size_t first_y) {
    const auto columns = places_around(first_x, x_.tile, x_.samples, x_.reach, field.periodic());
    const auto rows = places_around(first_y, y_.tile, y_.samples, y_.reach, field.periodic());
    bool whole = true;
    std::vector<double> weights(x_.length * y_.length, 0.0);
    std::ranges::fill(fft_.real(), 0.0);
    for (std::size_t r = 0; r < rows.size(); ++r) {
      for (std::size_t c = 0; c < columns.size(); ++c) {
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
    std::vector<double> sums(x_.tile * y_.tile);
    for (std::size_t row = 0; row < y_.tile; ++row)
      std::ranges::copy(fft_.real().subspan((row + y_.reach) * x_.length + x_.reach, x_.tile),
                        sums.begin() + static_cast<std::ptrdiff_t>(row * x_.tile));
    return sums;
  }

  template <class Value>
  void write(const HeightField& field, std::size_t first_x, std::size_t first_y, std::size_t width, std::size_t height,
             HeightField& result, const Value& value) const {
    for (std::size_t r = 0; r < height; ++r)
      for (std::size_t c = 0; c < width; ++c) {
        if (std::isnan(field.at(first_x + c, first_y + r))) continue;
        result.at(first_x + c, first_y + r) = static_cast<float>(value(r * x_.tile + c));
      }
  }

  const Axis &x_, &y_;
  RealFft2d fft_;
  std::vector<Complex> heights_, weights_;
};

}  // namespace

HeightField filter_by_fft(const HeightField& field, const GaussianWindow& window_x, const GaussianWindow& window_y) {
  const Axis x(window_x), y(window_y);
  HeightField result = field;
  tbb::enumerable_thread_specific<Tile> tiles(x, y);
  tbb::parallel_for(std::size_t{0}, x.tiles() * y.tiles(),
                    [&](std::size_t tile) { tiles.local().filter(field, tile % x.tiles(), tile / x.tiles(), result); });
  return result;
}

}  // namespace mezzotint
