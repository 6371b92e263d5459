#include "forward/scattering/cell_density.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>

#include <tbb/parallel_for.h>

namespace mezzotint {

namespace {

constexpr std::uint32_t edge = 8;
constexpr std::size_t block_cells = std::size_t{edge} * edge;
constexpr float below_one = 0x1.fffffep-1F;
constexpr std::size_t slice = 256;

// The bits 0, 2, 4, … of a number, moved together.
constexpr std::uint32_t even_bits(std::uint64_t x) {
  std::uint32_t result = 0;
  for (std::uint32_t bit = 0; bit < 32; ++bit) result |= static_cast<std::uint32_t>((x >> (2 * bit)) & 1U) << bit;
  return result;
}

struct Order {
  std::array<std::uint8_t, block_cells> column{}, row{};
};
constexpr Order make_order() {
  Order order;
  for (std::size_t k = 0; k < block_cells; ++k) {
    order.column[k] = static_cast<std::uint8_t>(even_bits(k));
    order.row[k] = static_cast<std::uint8_t>(even_bits(k >> 1));
  }
  return order;
}
constexpr Order in_block = make_order();

}  // namespace

CellDensity::CellDensity(std::uint32_t columns, std::uint32_t rows, const std::vector<float>& importance) {
  const std::uint32_t across = (columns + edge - 1) / edge, along = (rows + edge - 1) / edge;
  const std::uint64_t square = std::uint64_t{1} << (2 * std::bit_width(std::max(across, along) - 1));
  for (std::uint64_t k = 0; k < square; ++k) {
    const std::uint32_t column = even_bits(k), row = even_bits(k >> 1);
    if (column < across && row < along) blocks_.push_back({edge * column, edge * row, 0.0});
  }
  sums_.resize(blocks_.size() * block_cells);
  tbb::parallel_for(std::size_t{0}, blocks_.size(), [&](std::size_t k) {
    float sum = 0.0F;
    for (std::size_t cell = 0; cell < block_cells; ++cell) {
      const std::uint32_t column = blocks_[k].column + in_block.column[cell];
      const std::uint32_t row = blocks_[k].row + in_block.row[cell];
      if (column < columns && row < rows) sum += importance[std::size_t{row} * columns + column];
      sums_[k * block_cells + cell] = sum;
    }
  });
  double total = 0.0;
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    blocks_[k].before = total;
    total += double{sums_[k * block_cells + block_cells - 1]};
  }
  assert(total > 0.0);
  blocks_.push_back({0, 0, total});
  mean_ = total / (double{1} * columns * rows);
}

// The block that holds a place on the line of all densities. Places mostly come in their order: first a look ahead.
std::size_t CellDensity::block_at(double place, std::size_t from) const {
  constexpr std::size_t near = 4;
  const auto holds = [&](std::size_t k) { return blocks_[k].before <= place && place < blocks_[k + 1].before; };
  for (std::size_t k = from; k < std::min(from + near, blocks_.size() - 1); ++k)
    if (holds(k)) return k;
  const auto after = std::upper_bound(blocks_.begin(), blocks_.end(), place,
                                      [](double value, const Block& block) { return value < block.before; });
  std::size_t k = static_cast<std::size_t>(after - blocks_.begin());
  k = std::min(k, blocks_.size() - 1) - 1;
  // Rounding may take a place to the end of everything, behind the last block that has any.
  while (blocks_[k].before == blocks_[k + 1].before) --k;
  return k;
}

void CellDensity::place(const Block& block, double place, double aside, std::size_t at, SurfacePoints& points) const {
  const float* sums = sums_.data() + static_cast<std::size_t>(&block - blocks_.data()) * block_cells;
  const double here = std::min(place - block.before, std::nextafter(double{sums[block_cells - 1]}, 0.0));
  std::size_t cell = 0;
  for (std::size_t half = block_cells / 2; half > 0; half /= 2)
    if (double{sums[cell + half - 1]} <= here) cell += half;
  const float before = cell == 0 ? 0.0F : sums[cell - 1], density = sums[cell] - before;
  points.cell_x[at] = static_cast<std::int32_t>(block.column + in_block.column[cell]);
  points.cell_y[at] = static_cast<std::int32_t>(block.row + in_block.row[cell]);
  points.x[at] = std::min(below_one, static_cast<float>((here - double{before}) / double{density}));
  points.y[at] = std::min(below_one, static_cast<float>(aside));
  points.weight[at] = static_cast<float>(mean_ / double{density});
}

void CellDensity::points(const SampleStrata& strata, std::uint64_t first, std::size_t count,
                         SurfacePoints& points) const {
  std::array<double, slice> u{}, v{};
  std::size_t block = 0;
  for (std::size_t begin = 0; begin < count; begin += slice) {
    const std::size_t here = std::min(slice, count - begin);
    strata.points_on_line(first + begin, std::span(u).first(here), std::span(v).first(here));
    for (std::size_t k = 0; k < here; ++k) {
      const double where = u[k] * blocks_.back().before;
      block = block_at(where, block);
      place(blocks_[block], where, v[k], begin + k, points);
    }
  }
}

}  // namespace mezzotint
