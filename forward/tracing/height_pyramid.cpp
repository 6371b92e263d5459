#include "forward/tracing/height_pyramid.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <new>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

namespace mezzotint {

namespace {

std::int32_t log2_up(std::int32_t count) { return std::bit_width(static_cast<std::uint32_t>(count - 1)); }

}  // namespace

HeightPyramid::Array HeightPyramid::make_array(std::size_t size) {
  auto* memory = static_cast<float*>(std::calloc(size, sizeof(float)));
  if (memory == nullptr) throw std::bad_alloc();
  return Array(memory);
}

HeightPyramid::HeightPyramid(const PeriodicTile& tile)
    : columns(static_cast<std::int32_t>(tile.columns())),
      rows(static_cast<std::int32_t>(tile.rows())),
      log2_columns(log2_up(columns)),
      log2_rows(log2_up(rows)),
      top_level(std::min(log2_columns, log2_rows)),
      cell_y(static_cast<float>(tile.cell_y())) {
  samples_ = make_array(static_cast<std::size_t>(columns + 1) * static_cast<std::size_t>(rows + 1));
  fill_samples(tile);
  const std::size_t nodes = std::size_t{2} << (log2_columns + log2_rows);
  above_ = make_array(nodes);
  below_ = make_array(nodes);
  fill_cells();
  for (std::int32_t level = 1; level <= top_level; ++level) fill_level(level);
}

void HeightPyramid::fill_samples(const PeriodicTile& tile) {
  for (std::int32_t row = 0; row <= rows; ++row) {
    float* line = samples_.get() + static_cast<std::size_t>(row) * static_cast<std::size_t>(columns + 1);
    const auto source = static_cast<std::uint32_t>(row == rows ? 0 : row);
    for (std::int32_t column = 0; column < columns; ++column)
      line[column] = tile.height(static_cast<std::uint32_t>(column), source);
    line[columns] = line[0];
  }
}

void HeightPyramid::fill_cells() {
  struct Extremes {
    float highest = -HUGE_VALF, lowest = HUGE_VALF, steepest = 0.0F;
    void join(const Extremes& other) {
      highest = std::max(highest, other.highest);
      lowest = std::min(lowest, other.lowest);
      steepest = std::max(steepest, other.steepest);
    }
  };
  const float per_y = 1.0F / cell_y;
  const auto stride = static_cast<std::size_t>(columns + 1);
  const auto fill = [&](const tbb::blocked_range<std::int32_t>& range, Extremes extremes) {
    for (std::int32_t row = range.begin(); row < range.end(); ++row) {
      const float* line = samples_.get() + static_cast<std::size_t>(row) * stride;
      const std::size_t first = node(0, 0, row);
      for (std::int32_t column = 0; column < columns; ++column) {
        const float z00 = line[column], z10 = line[column + 1];
        const float z01 = line[stride + static_cast<std::size_t>(column)],
                    z11 = line[stride + static_cast<std::size_t>(column) + 1];
        const float high = std::max(std::max(z00, z10), std::max(z01, z11));
        const float low = std::min(std::min(z00, z10), std::min(z01, z11));
        above_[first + static_cast<std::size_t>(column)] = high;
        below_[first + static_cast<std::size_t>(column)] = -low;
        const float ax = z10 - z00, ay = (z11 - z10) * per_y, bx = z11 - z01, by = (z01 - z00) * per_y;
        const float steep = std::max(ax * ax + ay * ay, bx * bx + by * by);
        extremes.highest = std::max(extremes.highest, high);
        extremes.lowest = std::min(extremes.lowest, low);
        extremes.steepest = std::max(extremes.steepest, steep);
      }
    }
    return extremes;
  };
  const auto join = [](Extremes a, const Extremes& b) {
    a.join(b);
    return a;
  };
  const Extremes all = tbb::parallel_reduce(tbb::blocked_range<std::int32_t>(0, rows, 64), Extremes{}, fill, join);
  highest = all.highest;
  lowest = all.lowest;
  steepest = std::sqrt(all.steepest);
}

void HeightPyramid::fill_level(std::int32_t level) {
  const std::int32_t width = ((columns - 1) >> level) + 1, height = ((rows - 1) >> level) + 1;
  const std::int32_t finer_width = ((columns - 1) >> (level - 1)) + 1, finer_height = ((rows - 1) >> (level - 1)) + 1;
  const auto fill_row = [&](std::int32_t y) {
    const std::int32_t y0 = 2 * y, y1 = std::min(2 * y + 1, finer_height - 1);
    for (std::int32_t x = 0; x < width; ++x) {
      const std::int32_t x0 = 2 * x, x1 = std::min(2 * x + 1, finer_width - 1);
      for (float* all : {above_.get(), below_.get()}) {
        all[node(level, x, y)] = std::max(std::max(all[node(level - 1, x0, y0)], all[node(level - 1, x1, y0)]),
                                          std::max(all[node(level - 1, x0, y1)], all[node(level - 1, x1, y1)]));
      }
    }
  };
  tbb::parallel_for(std::int32_t{0}, height, fill_row);
}

}  // namespace mezzotint
