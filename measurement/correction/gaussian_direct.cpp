#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "measurement/correction/convolution.h"
#include "measurement/correction/gaussian_window.h"

namespace mezzotint {

namespace {

using Values = std::vector<double>;

/// One axis: weights times x^a for a = 0, 1, 2, x the way from the sample, from −reach to reach.
struct Taps {
  std::size_t samples, reach, tile;
  std::array<Values, 3> power;

  explicit Taps(const GaussianWindow& window)
      : samples(window.samples), reach(window.reach), tile(std::min(samples, std::max<std::size_t>(256, 4 * reach))) {
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t k = 0; k <= 2 * reach; ++k) {
        const double x = static_cast<double>(k) - static_cast<double>(reach);
        power[a].push_back(window.weights[k < reach ? reach - k : k - reach] * std::pow(x, static_cast<double>(a)));
      }
  }
  [[nodiscard]] std::size_t tiles() const { return (samples + tile - 1) / tile; }
};

void transpose(const Values& in, std::size_t rows, std::size_t columns, Values& out) {
  constexpr std::size_t block = 16;
  for (std::size_t r0 = 0; r0 < rows; r0 += block)
    for (std::size_t c0 = 0; c0 < columns; c0 += block)
      for (std::size_t r = r0; r < std::min(rows, r0 + block); ++r)
        for (std::size_t c = c0; c < std::min(columns, c0 + block); ++c) out[c * rows + r] = in[r * columns + c];
}

/// A tile with all that its filter reaches. Along x first: its samples lie transposed, so that both axes are convolved
/// along columns of an array.
class Tile {
public:
  Tile(const Taps& x, const Taps& y) : x_(x), y_(y) {}

  void filter(const HeightField& field, const std::vector<std::ptrdiff_t>& columns,
              const std::vector<std::ptrdiff_t>& rows, std::size_t first_x, std::size_t first_y, HeightField& result) {
    width_ = columns.size() - 2 * x_.reach;
    height_ = rows.size() - 2 * y_.reach;
    const bool whole = load(field, columns, rows);
    along_x(heights_, 0);
    along_y(0, sums_[6]);
    if (!whole) other_moments();
    for (std::size_t r = 0; r < height_; ++r)
      for (std::size_t c = 0; c < width_; ++c) {
        if (std::isnan(field.at(first_x + c, first_y + r))) continue;
        const std::size_t k = r * width_ + c;
        result.at(first_x + c, first_y + r) = static_cast<float>(whole ? sums_[6][k] : moments_at(k).plane_height());
      }
  }

private:
  // Whether every sample is measured.
  bool load(const HeightField& field, const std::vector<std::ptrdiff_t>& columns,
            const std::vector<std::ptrdiff_t>& rows) {
    bool whole = true;
    heights_.resize(columns.size() * rows.size());
    measured_.resize(heights_.size());
    for (std::size_t r = 0; r < rows.size(); ++r)
      for (std::size_t c = 0; c < columns.size(); ++c) {
        const bool inside = rows[r] >= 0 && columns[c] >= 0;
        const float z = inside ? field.at(static_cast<std::size_t>(columns[c]), static_cast<std::size_t>(rows[r]))
                               : std::numeric_limits<float>::quiet_NaN();
        const bool measured = z == z;
        whole &= measured;
        heights_[c * rows.size() + r] = measured ? static_cast<double>(z) : 0.0;
        measured_[c * rows.size() + r] = measured ? 1.0 : 0.0;
      }
    return whole;
  }

  // Moment a of the values along x, turned back into rows.
  void along_x(const Values& values, std::size_t a) {
    const std::size_t rows = height_ + 2 * y_.reach;
    turned_.resize(width_ * rows);
    rows_.resize(width_ * rows);
    convolve_columns(values.data(), width_, rows, x_.power[a].data(), x_.power[a].size(), turned_.data());
    transpose(turned_, width_, rows, rows_);
  }

  void along_y(std::size_t b, Values& sums) {
    sums.resize(width_ * height_);
    convolve_columns(rows_.data(), height_, width_, y_.power[b].data(), y_.power[b].size(), sums.data());
  }

  // In the order of LocalMoments.
  void other_moments() {
    along_y(1, sums_[8]);
    along_x(heights_, 1);
    along_y(0, sums_[7]);
    along_x(measured_, 0);
    along_y(0, sums_[0]);
    along_y(1, sums_[2]);
    along_y(2, sums_[5]);
    along_x(measured_, 1);
    along_y(0, sums_[1]);
    along_y(1, sums_[4]);
    along_x(measured_, 2);
    along_y(0, sums_[3]);
  }

  [[nodiscard]] LocalMoments moments_at(std::size_t k) const {
    return {sums_[0][k], sums_[1][k], sums_[2][k], sums_[3][k], sums_[4][k],
            sums_[5][k], sums_[6][k], sums_[7][k], sums_[8][k]};
  }

  const Taps &x_, &y_;
  std::size_t width_ = 0, height_ = 0;
  Values heights_, measured_, turned_, rows_;
  std::array<Values, 9> sums_;
};

}  // namespace

HeightField filter_directly(const HeightField& field, const GaussianWindow& window_x, const GaussianWindow& window_y) {
  const Taps x(window_x), y(window_y);
  HeightField result = field;
  tbb::enumerable_thread_specific<Tile> workspaces(x, y);
  tbb::parallel_for(std::size_t{0}, x.tiles() * y.tiles(), [&](std::size_t tile) {
    const std::size_t first_x = tile % x.tiles() * x.tile, first_y = tile / x.tiles() * y.tile;
    const auto columns =
        places_around(first_x, std::min(x.tile, x.samples - first_x), x.samples, x.reach, field.periodic());
    const auto rows =
        places_around(first_y, std::min(y.tile, y.samples - first_y), y.samples, y.reach, field.periodic());
    workspaces.local().filter(field, columns, rows, first_x, first_y, result);
  });
  return result;
}

}  // namespace mezzotint
