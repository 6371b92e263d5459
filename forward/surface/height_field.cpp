#include "forward/surface/height_field.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

constexpr std::size_t largest_sample_count = std::size_t{1} << 30;

constexpr std::uint32_t infinity_bits = 0x7F800000;

// The height without its sign, as bits: above those of infinity it is NaN.
std::uint32_t magnitude_bits(float z) { return std::bit_cast<std::uint32_t>(z) & 0x7FFFFFFFU; }

// In pieces without a way out, which the compiler makes vectors of.
bool has_infinite(std::span<const float> heights_um) {
  constexpr std::size_t piece = 4096;
  for (std::size_t begin = 0; begin < heights_um.size(); begin += piece) {
    std::uint32_t found = 0;
    for (const float z : heights_um.subspan(begin, std::min(piece, heights_um.size() - begin)))
      found |= magnitude_bits(z) == infinity_bits ? 1U : 0U;
    if (found != 0) return true;
  }
  return false;
}

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
  require(!has_infinite(heights_um_), "an infinite height; a missing sample is NaN");
}

std::size_t HeightField::missing_count() const {
  constexpr std::size_t piece = std::size_t{1} << 20;
  std::size_t missing = 0;
  for (std::size_t begin = 0; begin < heights_um_.size(); begin += piece) {
    std::uint32_t count = 0;
    for (const float z : heights_um().subspan(begin, std::min(piece, heights_um_.size() - begin)))
      count += magnitude_bits(z) > infinity_bits ? 1U : 0U;
    missing += count;
  }
  return missing;
}

HeightRange height_range(const HeightField& field) {
  // NaN compares as neither; several at once, since one after the other each would wait for the one before.
  constexpr std::size_t lanes = 32;
  std::array<float, lanes> lowest{}, highest{};
  lowest.fill(std::numeric_limits<float>::infinity());
  highest.fill(-std::numeric_limits<float>::infinity());
  const std::span<const float> heights_um = field.heights_um();
  const std::size_t whole = heights_um.size() / lanes * lanes;
  for (std::size_t i = 0; i < whole; i += lanes)
    for (std::size_t k = 0; k < lanes; ++k) {
      const float z = heights_um[i + k];
      lowest[k] = z < lowest[k] ? z : lowest[k];
      highest[k] = z > highest[k] ? z : highest[k];
    }
  for (const float z : heights_um.subspan(whole)) {
    lowest[0] = z < lowest[0] ? z : lowest[0];
    highest[0] = z > highest[0] ? z : highest[0];
  }
  const float low = *std::ranges::min_element(lowest), high = *std::ranges::max_element(highest);
  require(low <= high, "a height field without a single measured sample has no range");
  return {Length::from_um(low), Length::from_um(high)};
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
