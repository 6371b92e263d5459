#include <cmath>
#include <functional>

#include "forward/bsdf_table/incidence_refinement.h"

namespace mezzotint {

namespace {

using BinImage = std::function<std::size_t(std::size_t column, std::size_t row)>;

DirectionMap mean_with_image(const DirectionGrid& grid, const DirectionMap& map, const BinImage& image) {
  DirectionMap mean(map.size());
  for (std::size_t k = 0; k < map.size(); ++k) mean[k] = 0.5 * (map[k] + map[image(k % grid.width, k / grid.width)]);
  return mean;
}

// The noise of a bin and that of its image are independent; a bin that is its own image gains nothing.
DirectionMap error_with_image(const DirectionGrid& grid, const DirectionMap& errors, const BinImage& image) {
  DirectionMap mean(errors.size());
  for (std::size_t k = 0; k < errors.size(); ++k) {
    const std::size_t other = image(k % grid.width, k / grid.width);
    mean[k] = other == k ? errors[k] : 0.5 * std::hypot(errors[k], errors[other]);
  }
  return mean;
}

void average_with_image(Bsdf& bsdf, const BinImage& image) {
  for (MapEstimate* map : {&bsdf.reflection, &bsdf.transmission}) {
    map->mean = mean_with_image(bsdf.grid, map->mean, image);
    map->standard_error = error_with_image(bsdf.grid, map->standard_error, image);
    map->half_a = mean_with_image(bsdf.grid, map->half_a, image);
    map->half_b = mean_with_image(bsdf.grid, map->half_b, image);
  }
}

}  // namespace

void impose_isotropy(Bsdf& bsdf) {
  const DirectionGrid grid = bsdf.grid;
  const auto across_x = [=](std::size_t column, std::size_t row) {
    return (grid.height - 1 - row) * grid.width + column;
  };
  const auto across_y = [=](std::size_t column, std::size_t row) { return row * grid.width + grid.width - 1 - column; };
  const auto across_diagonal = [=](std::size_t column, std::size_t row) { return column * grid.width + row; };
  average_with_image(bsdf, across_x);
  if (bsdf.incidence.theta.radians() != 0.0) return;
  average_with_image(bsdf, across_y);
  if (grid.width == grid.height) average_with_image(bsdf, across_diagonal);
}

}  // namespace mezzotint
