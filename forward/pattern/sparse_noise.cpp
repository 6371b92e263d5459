#include "forward/pattern/sparse_noise.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "forward/base/error.h"
#include "forward/base/random.h"

namespace mezzotint {

namespace {

constexpr int impulses_per_cell = 30;
constexpr double largest_coordinate = 1048576.0;
constexpr std::size_t largest_cell_count = std::size_t{1} << 22;

double normalisation() { return 4.0 / (5.0 * std::cbrt(static_cast<double>(impulses_per_cell))); }

struct Cell {
  std::int64_t x, y, z;
};

std::uint64_t cell_index(const Cell& cell, CellHash hash) {
  if (hash == CellHash::Slides) return static_cast<std::uint64_t>(cell.x + 1000 * cell.y + 576 * cell.z);
  const auto packed = [](std::int64_t value) { return static_cast<std::uint64_t>(value) & 0x1FFFFFU; };
  return packed(cell.x) | packed(cell.y) << 21U | packed(cell.z) << 42U;
}

struct Impulse {
  double x, y, z;  ///< within the cell, in [0, 1)
  double weight;
};

Impulse impulse(const RandomStream& stream, std::uint64_t index, int j) {
  const auto u = stream.uniform4(index, static_cast<std::uint32_t>(j));
  return {u[0], u[1], u[2], u[3] * (1 - 2 * (j % 2))};
}

std::int64_t floor_cell(double coordinate) { return static_cast<std::int64_t>(std::floor(coordinate)); }

}  // namespace

double sparse_noise(double x, double y, double z, std::uint64_t seed, CellHash hash) {
  const RandomStream stream(seed, RandomPurpose::PatternImpulse);
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Cell cell{floor_cell(x - 0.5) + (corner & 1), floor_cell(y - 0.5) + (corner >> 1 & 1),
                    floor_cell(z - 0.5) + (corner >> 2)};
    const std::uint64_t index = cell_index(cell, hash);
    for (int j = 0; j < impulses_per_cell; ++j) {
      const Impulse at = impulse(stream, index, j);
      const double dx = static_cast<double>(cell.x) + at.x - x, dy = static_cast<double>(cell.y) + at.y - y;
      const double dz = static_cast<double>(cell.z) + at.z - z;
      const double falloff = std::max(0.0, 1.0 - 4.0 * (dx * dx + dy * dy + dz * dz));
      sum += at.weight * falloff * falloff * falloff;
    }
  }
  return normalisation() * sum;
}

NoisePlane::NoisePlane(std::uint64_t seed, CellHash hash, double z, const NoiseBounds& bounds) {
  const double extreme = std::max(
      {std::abs(bounds.x_low), std::abs(bounds.x_high), std::abs(bounds.y_low), std::abs(bounds.y_high), std::abs(z)});
  require(extreme < largest_coordinate - 1.0 && bounds.x_low <= bounds.x_high && bounds.y_low <= bounds.y_high,
          "the noise lattice holds 2^20 cells a side; the patch is too large for this scale");
  first_column_ = floor_cell(bounds.x_low - 0.5);
  first_row_ = floor_cell(bounds.y_low - 0.5);
  columns_ = static_cast<std::size_t>(floor_cell(bounds.x_high + 0.5) - first_column_ + 1);
  rows_ = static_cast<std::size_t>(floor_cell(bounds.y_high + 0.5) - first_row_ + 1);
  require(columns_ <= largest_cell_count / rows_, "the patch holds more than 2^22 noise cells; use a larger scale");
  cells_.reserve(columns_ * rows_);
  for (std::size_t row = 0; row < rows_; ++row) {
    for (std::size_t column = 0; column < columns_; ++column) {
      gather_cell(seed, hash, z, first_column_ + static_cast<std::int64_t>(column),
                  first_row_ + static_cast<std::int64_t>(row));
    }
  }
}

void NoisePlane::add_impulse(double x, double y, double headroom, double weight) {
  x_.push_back(static_cast<float>(x));
  y_.push_back(static_cast<float>(y));
  headroom_.push_back(static_cast<float>(headroom));
  weight_.push_back(static_cast<float>(weight));
}

// Both layers of cells that reach the plane, without the impulses that do not.
void NoisePlane::gather_cell(std::uint64_t seed, CellHash hash, double z, std::int64_t column, std::int64_t row) {
  const RandomStream stream(seed, RandomPurpose::PatternImpulse);
  const std::size_t begin = x_.size();
  for (int layer = 0; layer < 2; ++layer) {
    const Cell cell{column, row, floor_cell(z - 0.5) + layer};
    const std::uint64_t index = cell_index(cell, hash);
    for (int j = 0; j < impulses_per_cell; ++j) {
      const Impulse at = impulse(stream, index, j);
      const double dz = static_cast<double>(cell.z) + at.z - z;
      const double headroom = 1.0 - 4.0 * dz * dz;
      if (headroom <= 0.0) continue;
      add_impulse(at.x, at.y, headroom, at.weight);
    }
  }
  while ((x_.size() - begin) % lanes != 0) add_impulse(0.0, 0.0, 0.0, 0.0);
  cells_.push_back({begin, x_.size()});
}

double NoisePlane::cell_sum(const CellRange& cell, float px, float py) const {
  std::array<float, lanes> sums{};
  for (std::size_t i = cell.begin; i < cell.end; i += lanes) {
    for (std::size_t k = 0; k < lanes; ++k) {
      const float dx = x_[i + k] - px, dy = y_[i + k] - py;
      const float falloff = std::max(0.0F, headroom_[i + k] - 4.0F * (dx * dx + dy * dy));
      sums[k] += weight_[i + k] * falloff * falloff * falloff;
    }
  }
  double sum = 0.0;
  for (const float lane : sums) sum += static_cast<double>(lane);
  return sum;
}

double NoisePlane::operator()(double x, double y) const {
  const std::int64_t left = floor_cell(x - 0.5), low = floor_cell(y - 0.5);
  double sum = 0.0;
  for (int corner = 0; corner < 4; ++corner) {
    const std::int64_t column = left + (corner & 1), row = low + (corner >> 1);
    const CellRange cell = cells_[static_cast<std::size_t>(row - first_row_) * columns_ +
                                  static_cast<std::size_t>(column - first_column_)];
    // Relative to the cell's corner, where float holds its digits however far the cell is.
    const auto px = static_cast<float>(x - static_cast<double>(column));
    const auto py = static_cast<float>(y - static_cast<double>(row));
    sum += cell_sum(cell, px, py);
  }
  return normalisation() * sum;
}

}  // namespace mezzotint
