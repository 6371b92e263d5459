#include "forward/surface/height_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

constexpr std::size_t largest_sample_count = std::size_t{1} << 30;

bool positive_and_finite(Length pitch) { return std::isfinite(pitch.um()) && pitch.um() > 0.0; }

}  // namespace

void require_valid_grid(const Grid& grid) {
  require(grid.columns > 0 && grid.rows > 0, "a height field needs at least one sample");
  require(grid.columns <= largest_sample_count / grid.rows, "a height field of " + std::to_string(grid.columns) +
                                                                " × " + std::to_string(grid.rows) +
                                                                " samples is too large; 2^30 samples are the limit");
  require(positive_and_finite(grid.pitch_x) && positive_and_finite(grid.pitch_y),
          "the sample pitch must be positive and finite");
}

HeightField::HeightField(const Grid& grid, Continuation continuation) : grid_(grid), continuation_(continuation) {
  require_valid_grid(grid);
  heights_um_.assign(grid.size(), 0.0F);
}

HeightField::HeightField(const Grid& grid, Continuation continuation, std::vector<float> heights_um, Length datum)
    : grid_(grid), continuation_(continuation), heights_um_(std::move(heights_um)), datum_(datum) {
  require_valid_grid(grid);
  require(heights_um_.size() == grid.size(), "the number of heights does not match the grid");
  const bool infinite = std::any_of(heights_um_.begin(), heights_um_.end(), [](float z) { return std::isinf(z); });
  require(!infinite, "an infinite height; a missing sample is NaN");
}

std::size_t HeightField::missing_count() const {
  return static_cast<std::size_t>(
      std::count_if(heights_um_.begin(), heights_um_.end(), [](float z) { return std::isnan(z); }));
}

HeightRange height_range(const HeightField& field) {
  float lowest = std::numeric_limits<float>::infinity();
  float highest = -lowest;
  for (const float z : field.heights_um()) {
    if (std::isnan(z)) continue;
    lowest = std::min(lowest, z);
    highest = std::max(highest, z);
  }
  require(lowest <= highest, "a height field without a single measured sample has no range");
  return {Length::from_um(lowest), Length::from_um(highest)};
}

Length root_mean_square_height(const HeightField& field) {
  double sum = 0.0, squares = 0.0, count = 0.0;
  for (const float height : field.heights_um()) {
    if (std::isnan(height)) continue;
    const double z = double{height};
    sum += z;
    squares += z * z;
    count += 1.0;
  }
  require(count > 0.0, "every height is missing: there is no root mean square");
  return Length::from_um(std::sqrt(std::max(0.0, squares / count - sum * sum / (count * count))));
}

HeightField crop(const HeightField& field, std::size_t column, std::size_t row, std::size_t columns, std::size_t rows) {
  require(columns > 0 && rows > 0 && column < field.columns() && row < field.rows() &&
              columns <= field.columns() - column && rows <= field.rows() - row,
          "the crop reaches outside of the field of " + std::to_string(field.columns()) + " × " +
              std::to_string(field.rows()) + " samples");
  std::vector<float> heights_um;
  heights_um.reserve(columns * rows);
  for (std::size_t r = row; r < row + rows; ++r) {
    const auto begin = field.heights_um().begin() + static_cast<std::ptrdiff_t>(r * field.columns() + column);
    heights_um.insert(heights_um.end(), begin, begin + static_cast<std::ptrdiff_t>(columns));
  }
  const bool whole = columns == field.columns() && rows == field.rows();
  return HeightField({columns, rows, field.grid().pitch_x, field.grid().pitch_y},
                     whole ? field.continuation() : Continuation::Mirrored, std::move(heights_um), field.datum());
}

}  // namespace mezzotint
