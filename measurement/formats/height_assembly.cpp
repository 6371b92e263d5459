#include "measurement/formats/height_assembly.h"

#include <array>
#include <cmath>
#include <limits>
#include <numeric>
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

using Rows = std::function<void(std::size_t, std::span<double>)>;

void require_believable_heights(const std::filesystem::path& path, std::string_view place, std::size_t first,
                                std::span<const double> heights_m) {
  for (std::size_t k = 0; k < heights_m.size(); ++k) {
    const double z = heights_m[k];
    if (std::isnan(z) || std::abs(z) <= largest_height_m) continue;
    throw FileError(
        path, place,
        fmt::format("sample {} has a height of {} m; heights up to {} m are read", first + k, z, largest_height_m));
  }
}

/// Differences from the first measured height are small, so that their sum loses nothing of a large offset. Several
/// sums at once: one alone would wait for itself.
struct MeanHeight {
  double first = std::numeric_limits<double>::quiet_NaN();
  std::array<double, 8> sums{}, counts{};

  // Whether all heights are believable.
  bool add(std::span<const double> heights_m) {
    for (std::size_t k = 0; k < heights_m.size() && std::isnan(first); ++k) first = heights_m[k];
    bool good = true;
    for (std::size_t k = 0; k < heights_m.size(); ++k) {
      const double z = heights_m[k];
      const bool measured = z == z;
      good &= !measured | (std::abs(z) <= largest_height_m);
      sums[k % sums.size()] += measured ? z - first : 0.0;
      counts[k % counts.size()] += measured ? 1.0 : 0.0;
    }
    return good;
  }
  [[nodiscard]] double value_m() const {
    const double count = std::accumulate(counts.begin(), counts.end(), 0.0);
    return count > 0.0 ? first + std::accumulate(sums.begin(), sums.end(), 0.0) / count : 0.0;
  }
};

double mean_height_m(const std::filesystem::path& path, std::string_view place, const Grid& grid, const Rows& row_m) {
  MeanHeight mean;
  std::vector<double> line(grid.columns);
  for (std::size_t row = 0; row < grid.rows; ++row) {
    row_m(row, line);
    if (!mean.add(line)) require_believable_heights(path, place, row * grid.columns, line);
  }
  return mean.value_m();
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

HeightField assemble_rows(const std::filesystem::path& path, std::string_view place, const Grid& grid,
                          FirstRow first_row, Continuation continuation, const Rows& row_m) {
  const double mean_m = mean_height_m(path, place, grid, row_m);
  std::vector<float> heights_um(grid.size());
  std::vector<double> line(grid.columns);
  for (std::size_t row = 0; row < grid.rows; ++row) {
    row_m(first_row == FirstRow::Top ? grid.rows - 1 - row : row, line);
    float* const out = heights_um.data() + row * grid.columns;
    for (std::size_t column = 0; column < grid.columns; ++column)
      out[column] = static_cast<float>((line[column] - mean_m) * 1e6);
  }
  return HeightField(grid, continuation, std::move(heights_um), Length::from_m(mean_m));
}

}  // namespace mezzotint
