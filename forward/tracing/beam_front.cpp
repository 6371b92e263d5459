#include "forward/tracing/beam_front.h"

#include <algorithm>
#include <cmath>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace mezzotint {

namespace {

// A ray that starts this far (cells) too low might have passed a crest already; rounding is a thousandth of it.
constexpr double slack = 1e-3;

std::int32_t wrap(std::int32_t index, std::int32_t count) {
  const std::int32_t rest = index % count;
  return rest < 0 ? rest + count : rest;
}

}  // namespace

BeamFront::BeamFront(const HeightPyramid& relief, const Direction& travel, double plane)
    : columns_(relief.columns),
      rows_(relief.rows),
      plane_(plane),
      shift_x_(travel.x() / travel.z()),
      shift_y_(travel.y() / (travel.z() * static_cast<double>(relief.cell_y))) {
  const auto size = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
  // Two bands, each with a map of its own: which of two equal bounds is the larger needs no order.
  std::vector<std::vector<float>> bounds(2);
  tbb::parallel_for(0, 2, [&](int band) {
    auto& bound = bounds[static_cast<std::size_t>(band)];
    bound.assign(size, relief.lowest);
    cover(relief, band == 0 ? 0 : rows_ / 2, band == 0 ? rows_ / 2 : rows_, bound);
  });
  bound_ = std::move(bounds[0]);
  for (std::size_t k = 0; k < size; ++k) bound_[k] = std::max(bound_[k], bounds[1][k]) + static_cast<float>(slack);
}

void BeamFront::cover(const HeightPyramid& relief, std::int32_t first_row, std::int32_t end_row,
                      std::vector<float>& bound) const {
  const double shift = std::max(std::abs(shift_x_), std::abs(shift_y_));
  const float* above = relief.above();
  const float* below = relief.below();
  for (std::int32_t row = first_row; row < end_row; ++row) {
    const std::size_t line = relief.node(0, 0, row);
    for (std::int32_t column = 0; column < columns_; ++column) {
      const double high = double{above[line + static_cast<std::size_t>(column)]};
      const double low = -double{below[line + static_cast<std::size_t>(column)]};
      const int slabs = std::max(1, static_cast<int>(std::ceil(shift * (high - low))));
      const double thickness = (high - low) / slabs;
      for (int slab = 0; slab < slabs; ++slab) {
        const double bottom = low + slab * thickness, top = bottom + thickness;
        const double x0 = column - (bottom - plane_) * shift_x_, x1 = column - (top - plane_) * shift_x_;
        const double y0 = row - (bottom - plane_) * shift_y_, y1 = row - (top - plane_) * shift_y_;
        raise(bound, std::min(x0, x1), std::max(x0, x1) + 1.0, std::min(y0, y1), std::max(y0, y1) + 1.0,
              static_cast<float>(top));
      }
    }
  }
}

void BeamFront::raise(std::vector<float>& bound, double left, double right, double low, double high, float z) const {
  const auto first_x = static_cast<std::int32_t>(std::floor(left - slack));
  const auto last_x = static_cast<std::int32_t>(std::floor(right + slack));
  const auto first_y = static_cast<std::int32_t>(std::floor(low - slack));
  const auto last_y = static_cast<std::int32_t>(std::floor(high + slack));
  if (first_x >= 0 && last_x < columns_ && first_y >= 0 && last_y < rows_) {
    for (std::int32_t y = first_y; y <= last_y; ++y) {
      float* line = bound.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_);
      for (std::int32_t x = first_x; x <= last_x; ++x) line[x] = std::max(line[x], z);
    }
    return;
  }
  for (std::int32_t y = first_y; y <= last_y; ++y) {
    float* line = bound.data() + static_cast<std::size_t>(wrap(y, rows_)) * static_cast<std::size_t>(columns_);
    for (std::int32_t x = first_x; x <= last_x; ++x) {
      float& there = line[wrap(x, columns_)];
      there = std::max(there, z);
    }
  }
}

}  // namespace mezzotint
