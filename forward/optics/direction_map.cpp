#include "forward/optics/direction_map.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "forward/base/error.h"
#include "forward/optics/bin_pieces.h"

namespace mezzotint {

namespace {

std::size_t bin_along(double coordinate, std::size_t bins) {
  const double position = std::floor((coordinate + 1.0) * 0.5 * static_cast<double>(bins));
  return static_cast<std::size_t>(std::clamp(position, 0.0, static_cast<double>(bins - 1)));
}

struct WeightedSum {
  double sum = 0.0, weights = 0.0;
};

// The midpoint rule: it asks nothing of the function.
void add_patch(const BinPatch& patch, const std::function<double(const Direction&)>& function, std::size_t samples,
               WeightedSum& total) {
  const double step = 1.0 / static_cast<double>(samples);
  for (std::size_t i = 0; i < samples; ++i) {
    for (std::size_t j = 0; j < samples; ++j) {
      const auto [x, y, density] =
          patch.at((static_cast<double>(i) + 0.5) * step, (static_cast<double>(j) + 0.5) * step);
      total.sum += density * function({x, y, std::sqrt(std::max(0.0, 1.0 - x * x - y * y))});
      total.weights += density;
    }
  }
}

}  // namespace

void require_valid(const DirectionGrid& grid) {
  const auto fits = [](std::size_t bins) { return bins >= 1 && bins <= 4096; };
  require(fits(grid.width) && fits(grid.height), "a direction map has 1 to 4096 bins a side, not " +
                                                     std::to_string(grid.width) + " x " + std::to_string(grid.height));
}

std::size_t DirectionGrid::bin_of(double x, double y) const {
  return bin_along(y, height) * width + bin_along(x, width);
}

std::vector<double> projected_solid_angles(const DirectionGrid& grid) {
  require_valid(grid);
  std::vector<double> areas(grid.size());
  for (std::size_t row = 0; row < grid.height; ++row) {
    for (std::size_t column = 0; column < grid.width; ++column) {
      double area = 0.0;
      for (const BinPiece& piece : pieces_of_bin(grid, column, row)) area += area_in_disc(piece);
      areas[row * grid.width + column] = area;
    }
  }
  return areas;
}

DirectionMap average_over_bins(const DirectionGrid& grid, const std::function<double(const Direction&)>& function,
                               std::size_t samples) {
  require_valid(grid);
  require(samples >= 1 && samples <= 1024, "a bin is averaged over 1 to 1024 points a side");
  DirectionMap map(grid.size(), 0.0);
  for (std::size_t bin = 0; bin < map.size(); ++bin) {
    WeightedSum total;
    for (const BinPatch& patch : patches_of_bin(grid, bin % grid.width, bin / grid.width)) {
      add_patch(patch, function, samples, total);
    }
    if (total.weights > 0.0) map[bin] = total.sum / total.weights;
  }
  return map;
}

}  // namespace mezzotint
