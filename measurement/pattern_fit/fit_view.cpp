#include "measurement/pattern_fit/fit_view.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <unordered_map>

#include "forward/base/fft.h"
#include "measurement/correction/fill.h"
#include "measurement/correction/plane.h"

namespace mezzotint {

namespace {

constexpr std::size_t most_blocks = 10000;

std::vector<double> taper(std::size_t count) {
  std::vector<double> values(count, 1.0);
  const double ramp = 0.1 * static_cast<double>(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double from_end = static_cast<double>(std::min(i, count - 1 - i)) + 0.5;
    if (from_end < ramp) values[i] = 0.5 - 0.5 * std::cos(std::numbers::pi * from_end / ramp);
  }
  return values;
}

double sum_of_squares(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return sum;
}

// The largest power of two that is not above a number, as its exponent; 0 below 2.
unsigned floored_log2(double value) {
  return value < 2.0 ? 0U : static_cast<unsigned>(std::bit_width(static_cast<std::uint64_t>(value))) - 1U;
}

// Waves along y of row ky of a spectrum.
std::int64_t signed_wave(std::size_t ky, std::size_t rows) {
  return static_cast<std::int64_t>(ky) - (2 * ky > rows ? static_cast<std::int64_t>(rows) : 0);
}

bool counts(std::size_t kx, std::int64_t ky, const Grid& grid) {
  if (kx <= 1 && std::abs(ky) <= 1) return false;
  if (2 * kx == grid.columns || 2 * static_cast<std::size_t>(std::abs(ky)) == grid.rows) return false;
  return kx > 0 || ky > 0;  // of the column kx = 0 one half, which the other repeats
}

}  // namespace

FitView::FitView(const HeightField& scan)
    : grid_(scan.grid()), taper_x_(taper(scan.columns())), taper_y_(taper(scan.rows())) {
  const auto heights = scan.heights_um();
  for (std::size_t i = 0; i < heights.size(); ++i) {
    if (std::isnan(heights[i])) missing_.push_back(i);
  }
  std::size_t fineness = 256;
  do {
    gather(fineness);
    fineness /= 2;
  } while (blocks_.size() > most_blocks && fineness >= 8);
}

// Blocks are about 1/fineness of their distance from 0 wide.
void FitView::gather(std::size_t fineness) {
  const double width = static_cast<double>(grid_.columns) * grid_.pitch_x.um();
  const double depth = static_cast<double>(grid_.rows) * grid_.pitch_y.um();
  const std::size_t spectrum_columns = grid_.columns / 2 + 1;
  std::unordered_map<std::uint64_t, std::uint32_t> known;
  blocks_.clear();
  block_of_.assign(grid_.rows * spectrum_columns, std::numeric_limits<std::uint32_t>::max());
  for (std::size_t row = 0; row < grid_.rows; ++row) {
    const std::int64_t ky = signed_wave(row, grid_.rows);
    for (std::size_t kx = 0; kx < spectrum_columns; ++kx) {
      if (!counts(kx, ky, grid_)) continue;
      const double x = static_cast<double>(kx) / width, y = static_cast<double>(ky) / depth;
      const double waves = std::hypot(x, y) / static_cast<double>(fineness);
      const unsigned a = floored_log2(waves * width), b = floored_log2(waves * depth);
      const std::uint64_t key = std::uint64_t{a} << 60U | std::uint64_t{b} << 56U | std::uint64_t{kx >> a} << 28U |
                                static_cast<std::uint64_t>((ky >> b) + 0x7FFFFFF);
      const auto [place, is_new] = known.try_emplace(key, static_cast<std::uint32_t>(blocks_.size()));
      if (is_new) blocks_.emplace_back();
      FrequencyBlock& block = blocks_[place->second];
      block.x_per_um += x;
      block.y_per_um += y;
      block.count += 1.0;
      block_of_[row * spectrum_columns + kx] = place->second;
    }
  }
  for (FrequencyBlock& block : blocks_) {
    block.x_per_um /= block.count;
    block.y_per_um /= block.count;
  }
}

HeightField FitView::seen(const HeightField& field) const {
  HeightField patch(grid_, Continuation::Mirrored, {field.heights_um().begin(), field.heights_um().end()});
  for (const std::size_t i : missing_) patch.heights_um()[i] = std::numeric_limits<float>::quiet_NaN();
  return level(patch);
}

std::vector<double> FitView::periodogram(const HeightField& field) const {
  const HeightField whole = missing_.empty() ? field : fill_missing(field);
  RealFft2d fft(grid_.columns, grid_.rows);
  for (std::size_t row = 0; row < grid_.rows; ++row)
    for (std::size_t column = 0; column < grid_.columns; ++column)
      fft.real()[row * grid_.columns + column] =
          taper_x_[column] * taper_y_[row] * static_cast<double>(whole.at(column, row));
  fft.forward();
  const double scale = grid_.pitch_x.um() * grid_.pitch_y.um() / (sum_of_squares(taper_x_) * sum_of_squares(taper_y_));
  std::vector<double> density(blocks_.size(), 0.0);
  for (std::size_t i = 0; i < block_of_.size(); ++i) {
    if (block_of_[i] < density.size()) density[block_of_[i]] += scale * std::norm(fft.spectrum()[i]);
  }
  for (std::size_t i = 0; i < density.size(); ++i) density[i] /= blocks_[i].count;
  return density;
}

std::vector<double> FitView::audible(const HeightField& field) const {
  std::vector<double> density = periodogram(field);
  for (double& value : density) value += quiet_um4_;
  return density;
}

void FitView::listen_to(const std::vector<double>& periodogram_um4) {
  constexpr double quiet = 1e-6;  // of the mean density, weighted by power
  double power = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    power += blocks_[i].count * periodogram_um4[i];
    squares += blocks_[i].count * periodogram_um4[i] * periodogram_um4[i];
  }
  quiet_um4_ = power > 0.0 ? quiet * squares / power : 0.0;
}

}  // namespace mezzotint
