#include "forward/bsdf_table/adaptive_map.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "forward/optics/bin_pieces.h"

namespace mezzotint {

namespace {

double edge(std::size_t bin, std::size_t bins) {
  return (2.0 * static_cast<double>(bin) - static_cast<double>(bins)) / static_cast<double>(bins);
}

struct Rectangle {
  double x0, x1, y0, y1;

  [[nodiscard]] bool in_disc() const {
    const double x = std::max(std::abs(x0), std::abs(x1)), y = std::max(std::abs(y0), std::abs(y1));
    return x * x + y * y <= 1.0;
  }
};

// Exact area of rectangle ∩ disc, by its parts in each quadrant.
double area(const Rectangle& r) {
  if (r.x0 < 0.0 && r.x1 > 0.0) return area({r.x0, 0.0, r.y0, r.y1}) + area({0.0, r.x1, r.y0, r.y1});
  if (r.y0 < 0.0 && r.y1 > 0.0) return area({r.x0, r.x1, r.y0, 0.0}) + area({r.x0, r.x1, 0.0, r.y1});
  const bool left = r.x1 <= 0.0, below = r.y1 <= 0.0;
  return area_in_disc({left ? -r.x1 : r.x0, left ? -r.x0 : r.x1, below ? -r.y1 : r.y0, below ? -r.y0 : r.y1, 1.0, 1.0});
}

// Splits [0, 1) at the share of the first of two; u goes on as a uniform number of the part that it fell into.
bool takes_second(double first, double second, double& u) {
  const double share = first / (first + second);
  constexpr double below_one = 1.0 - 0x1p-53;
  if (u < share) {
    u = std::min(u / share, below_one);
    return false;
  }
  u = std::min((u - share) / (1.0 - share), below_one);
  return true;
}

// Uniform in rectangle ∩ disc: quarters by their areas until one lies inside.
Eigen::Vector2d uniform_in_disc(Rectangle r, double u1, double u2) {
  constexpr int most_quarterings = 60;
  for (int step = 0; step < most_quarterings && !r.in_disc(); ++step) {
    const double y = 0.5 * (r.y0 + r.y1);
    const double lower = area({r.x0, r.x1, r.y0, y}), upper = area({r.x0, r.x1, y, r.y1});
    if (!(lower + upper > 0.0)) break;
    (takes_second(lower, upper, u2) ? r.y0 : r.y1) = y;
    const double x = 0.5 * (r.x0 + r.x1);
    const double left = area({r.x0, x, r.y0, r.y1}), right = area({x, r.x1, r.y0, r.y1});
    if (!(left + right > 0.0)) break;
    (takes_second(left, right, u1) ? r.x0 : r.x1) = x;
  }
  const Eigen::Vector2d point(r.x0 + u1 * (r.x1 - r.x0), r.y0 + u2 * (r.y1 - r.y0));
  return point / std::max(1.0, point.norm());  // the last splinter of the rim
}

}  // namespace

unsigned AdaptiveMap::levels_of(const DirectionGrid& grid) {
  unsigned level = 0;
  while ((std::size_t{1} << level) < std::max(grid.width, grid.height)) ++level;
  return level;
}

AdaptiveMap::AdaptiveMap(const DirectionGrid& grid, const std::vector<double>& areas, const Divide& divide)
    : grid_(grid), cells_(1) {
  fill(0, 0, 0, levels_of(grid), areas, divide);
  cells_.shrink_to_fit();
}

void AdaptiveMap::fill(std::size_t cell, std::size_t x, std::size_t y, unsigned level, const std::vector<double>& areas,
                       const Divide& divide) {
  if (x >= grid_.width || y >= grid_.height) return;
  const std::size_t side = std::size_t{1} << level;
  if (const std::optional<Square> square = divide(x, y, level)) {
    double sum = 0.0;
    for (std::size_t row = y; row < std::min(y + side, grid_.height); ++row) {
      for (std::size_t column = x; column < std::min(x + side, grid_.width); ++column) {
        sum += areas[row * grid_.width + column];
      }
    }
    cells_[cell] = {double{square->value} * sum, 0, square->value, square->standard_error};
    return;
  }
  assert(level > 0);
  const std::size_t first = cells_.size(), half = side / 2;
  cells_.resize(first + 4);
  cells_[cell].first_child = static_cast<std::uint32_t>(first);
  for (std::size_t k = 0; k < 4; ++k)
    fill(first + k, x + (k & 1U) * half, y + (k >> 1U) * half, level - 1, areas, divide);
  for (std::size_t k = 0; k < 4; ++k) cells_[cell].integral += cells_[first + k].integral;
}

std::size_t AdaptiveMap::square_count() const {
  return static_cast<std::size_t>(
      std::count_if(cells_.begin(), cells_.end(), [](const Cell& cell) { return cell.first_child == 0; }));
}

AdaptiveMap::Square AdaptiveMap::at(double x, double y) const {
  if (cells_.empty()) return {};
  const std::size_t bin = grid_.bin_of(x, y);
  return at_bin(bin % grid_.width, bin / grid_.width);
}

AdaptiveMap::Square AdaptiveMap::at_bin(std::size_t column, std::size_t row) const {
  if (cells_.empty()) return {};
  unsigned level = levels_of(grid_);
  std::size_t cell = 0;
  while (cells_[cell].first_child != 0) {
    --level;
    cell = cells_[cell].first_child + (((row >> level) & 1U) << 1U) + ((column >> level) & 1U);
  }
  return {cells_[cell].value, cells_[cell].standard_error, level};
}

Eigen::Vector2d AdaptiveMap::sample(double u1, double u2) const {
  unsigned level = levels_of(grid_);
  std::size_t cell = 0, x = 0, y = 0;
  while (cells_[cell].first_child != 0) {
    --level;
    const Cell* child = &cells_[cells_[cell].first_child];
    const bool up = takes_second(child[0].integral + child[1].integral, child[2].integral + child[3].integral, u2);
    const std::size_t row = up ? 2 : 0;
    const bool right = takes_second(child[row].integral, child[row + 1].integral, u1);
    x += std::size_t{right} << level;
    y += std::size_t{up} << level;
    cell = cells_[cell].first_child + row + std::size_t{right};
  }
  return sample_block(x, y, level, u1, u2);
}

Eigen::Vector2d AdaptiveMap::sample_block(std::size_t x, std::size_t y, unsigned level, double u1, double u2) const {
  const std::size_t side = std::size_t{1} << level;
  const std::size_t right = std::min(x + side, grid_.width), top = std::min(y + side, grid_.height);
  return uniform_in_disc(
      {edge(x, grid_.width), edge(right, grid_.width), edge(y, grid_.height), edge(top, grid_.height)}, u1, u2);
}

}  // namespace mezzotint
