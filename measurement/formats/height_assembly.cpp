#include "measurement/formats/height_assembly.h"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

// Beyond these a header is damaged: arithmetic on them would overflow somewhere down the road.
constexpr double largest_height_m = 1e6;
constexpr double smallest_pitch_m = 1e-12;
constexpr double largest_pitch_m = 1e6;

bool believable(double pitch_m) { return pitch_m >= smallest_pitch_m && pitch_m <= largest_pitch_m; }

// Differences from the first measured height are small, so that the sum loses nothing of a large offset.
double mean_height_m(const std::filesystem::path& path, std::string_view place, std::size_t samples,
                     const std::function<double(std::size_t)>& height_m) {
  double first = std::numeric_limits<double>::quiet_NaN(), sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < samples; ++i) {
    const double z = height_m(i);
    if (std::isnan(z)) continue;
    if (!(std::abs(z) <= largest_height_m)) {
      throw FileError(
          path, place,
          fmt::format("sample {} has a height of {} m; heights up to {} m are read", i, z, largest_height_m));
    }
    if (count == 0.0) first = z;
    sum += z - first;
    count += 1.0;
  }
  return count > 0.0 ? first + sum / count : 0.0;
}

}  // namespace

Grid checked_grid(const std::filesystem::path& path, std::string_view place, const PromisedGrid& promised) {
  if (!believable(promised.pitch_x_m) || !believable(promised.pitch_y_m)) {
    throw FileError(path, place,
                    fmt::format("a sample pitch of {} m × {} m; both must lie between {} m and {} m",
                                promised.pitch_x_m, promised.pitch_y_m, smallest_pitch_m, largest_pitch_m));
  }
  const Grid grid{promised.columns, promised.rows, Length::from_m(promised.pitch_x_m),
                  Length::from_m(promised.pitch_y_m)};
  try {
    require_valid_grid(grid);
  } catch (const InvalidInput& error) {
    throw FileError(path, place, error.what());
  }
  return grid;
}

HeightField assemble_heights(const std::filesystem::path& path, std::string_view place, const Grid& grid,
                             FirstRow first_row, Continuation continuation,
                             const std::function<double(std::size_t)>& height_m) {
  const double mean_m = mean_height_m(path, place, grid.size(), height_m);
  std::vector<float> heights_um(grid.size());
  for (std::size_t row = 0; row < grid.rows; ++row) {
    const std::size_t source = first_row == FirstRow::Top ? grid.rows - 1 - row : row;
    for (std::size_t column = 0; column < grid.columns; ++column) {
      const double z = height_m(source * grid.columns + column) - mean_m;
      heights_um[row * grid.columns + column] = static_cast<float>(z * 1e6);
    }
  }
  return HeightField(grid, continuation, std::move(heights_um), Length::from_m(mean_m));
}

}  // namespace mezzotint
