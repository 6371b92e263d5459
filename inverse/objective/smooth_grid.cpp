#include "inverse/objective/smooth_grid.h"

#include <algorithm>
#include <cmath>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

constexpr std::size_t parts = 8;  // of a bin, a side, for the areas: midpoint rule, 1e-3 of a rim bin's

// Sums along one axis: out(bin) += share · in(part).
void gather_axis(const std::vector<double>& in, std::vector<double>& out, std::size_t lines, std::size_t bins,
                 bool along_rows) {
  const std::size_t fine = bins * parts;
  for (std::size_t part = 0; part < fine; ++part) {
    const SoftBins soft = soft_bins((static_cast<double>(part) + 0.5) / parts, bins);
    for (std::size_t line = 0; line < lines; ++line) {
      const double value = along_rows ? in[line * fine + part] : in[part * lines + line];
      for (std::size_t k = 0; k < 3; ++k)
        out[along_rows ? line * bins + soft.bin[k] : soft.bin[k] * lines + line] += soft.share[k] * value;
    }
  }
}

std::vector<double> soft_areas(const DirectionGrid& grid) {
  const std::vector<double> fine = projected_solid_angles({grid.width * parts, grid.height * parts});
  std::vector<double> columns(grid.width * grid.height * parts), areas(grid.size());
  gather_axis(fine, columns, grid.height * parts, grid.width, true);
  gather_axis(columns, areas, grid.width, grid.height, false);
  return areas;
}

// Light that walks to either neighbour along each axis with a chance of half the variance, in steps small enough for
// that, which adds the variance. Symmetric, so that it is its own transposed.
void walk(const DirectionGrid& grid, std::vector<double>& light, double variance) {
  const auto steps = static_cast<std::size_t>(std::ceil(2.0 * variance));
  const double chance = variance / (2.0 * static_cast<double>(std::max<std::size_t>(1, steps)));
  std::vector<double> next(light.size());
  const auto step_to = [&](std::size_t k, std::size_t before, std::size_t after) {
    next[k] = light[k] + chance * (light[before] - 2.0 * light[k] + light[after]);
  };
  const auto along_rows = [&](std::size_t first) {
    const std::size_t last = first + grid.width - 1;
    step_to(first, first, first + 1);
    for (std::size_t k = first + 1; k < last; ++k) step_to(k, k - 1, k + 1);
    step_to(last, last - 1, last);
  };
  const auto along_columns = [&](std::size_t row) {
    const std::size_t down = row == 0 ? 0 : grid.width, up = row + 1 == grid.height ? 0 : grid.width;
    for (std::size_t k = row * grid.width; k < (row + 1) * grid.width; ++k) step_to(k, k - down, k + up);
  };
  for (std::size_t step = 0; step < steps; ++step) {
    for (std::size_t row = 0; row < grid.height; ++row) along_rows(row * grid.width);
    light.swap(next);
    for (std::size_t row = 0; row < grid.height; ++row) along_columns(row);
    light.swap(next);
  }
}

std::vector<double> product(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> c(a.size());
  for (std::size_t k = 0; k < a.size(); ++k) c[k] = a[k] * b[k];
  return c;
}
std::vector<double> quotient(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> c(a.size());
  for (std::size_t k = 0; k < a.size(); ++k) c[k] = b[k] > 0.0 ? a[k] / b[k] : 0.0;
  return c;
}

}  // namespace

SmoothGrid::SmoothGrid(const DirectionGrid& grid) : grid_(grid) {
  require_valid(grid);
  require(std::min(grid.width, grid.height) >= 4 && std::max(grid.width, grid.height) <= 512,
          "a grid of soft bins has 4 to 512 bins a side");
  areas_ = soft_areas(grid);
}

DirectionMap SmoothGrid::softened(const DirectionMap& map) const {
  require(map.size() == grid_.size(), "a map of another grid");
  std::vector<double> light = product(map, projected_solid_angles(grid_));
  walk(grid_, light, 1.0 / 6.0);
  return quotient(light, areas_);
}

DirectionMap SmoothGrid::scattered(const DirectionMap& map, double variance) const {
  require(map.size() == grid_.size(), "a map of another grid");
  require(variance >= 0.0 && variance <= 1e4, "a variance of 0 to 10,000 squared bins");
  std::vector<double> light = product(map, areas_);
  walk(grid_, light, variance);
  return quotient(light, areas_);
}

std::vector<double> SmoothGrid::scattered_back(const std::vector<double>& derivatives, double variance) const {
  std::vector<double> of_light = quotient(derivatives, areas_);
  walk(grid_, of_light, variance);
  return product(of_light, areas_);
}

}  // namespace mezzotint
