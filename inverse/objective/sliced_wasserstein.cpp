#include "inverse/objective/sliced_wasserstein.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "inverse/objective/light_moments.h"

namespace mezzotint {

namespace {

constexpr std::size_t axes = 16;

// The bins in their order along an axis, with their places on it.
struct Line {
  std::vector<std::size_t> order;
  std::vector<double> place;  // of the bins in that order
};

Line line_along(const DirectionGrid& grid, double angle) {
  Line line;
  line.order.resize(grid.size());
  std::iota(line.order.begin(), line.order.end(), std::size_t{0});
  const Eigen::Vector2d axis(std::cos(angle), std::sin(angle));
  std::vector<double> places(grid.size());
  for (std::size_t k = 0; k < grid.size(); ++k) places[k] = axis.dot(bin_middle(grid, k));
  std::ranges::stable_sort(line.order, {}, [&](std::size_t k) { return places[k]; });
  for (const std::size_t k : line.order) line.place.push_back(places[k]);
  return line;
}

double square(double value) { return value * value; }

// Transport from f to g along a line, both of sum 1: adds its cost, and f's potential to `potential` (up to a
// constant). In one dimension light is moved in order. Wherever some goes from place i to place j the potentials obey
// φ_i + ψ_j = (x_i − x_j)², and each step of the walk shares i or j with the step before, which gives the next one.
double transport(const Line& line, std::span<const double> f, std::span<const double> g,
                 std::vector<double>& potential) {
  double cost = 0.0, phi = 0.0, psi = 0.0;
  std::size_t i = 0, j = 0;
  double left_f = f[line.order[0]], left_g = g[line.order[0]];
  potential[line.order[0]] += phi;
  const auto price = [&] { return square(line.place[i] - line.place[j]); };
  psi = price() - phi;
  while (true) {
    const double moved = std::min(left_f, left_g);
    cost += moved * price();
    left_f -= moved;
    left_g -= moved;
    if (left_f <= left_g) {
      if (++i == line.order.size()) break;
      left_f = f[line.order[i]];
      phi = price() - psi;
      potential[line.order[i]] += phi;
    } else {
      if (++j == line.order.size()) break;
      left_g = g[line.order[j]];
      psi = price() - phi;
    }
  }
  // Rounding may have used up g first: what is left of f stays where g ended.
  for (++i; i < line.order.size() && j == line.order.size(); ++i)
    potential[line.order[i]] += square(line.place[i] - line.place.back()) - psi;
  return cost;
}

std::vector<double> light_shares(const SmoothGrid& grid, std::span<const double> lobe, double light) {
  std::vector<double> shares(lobe.size());
  for (std::size_t k = 0; k < lobe.size(); ++k) shares[k] = grid.areas()[k] * lobe[k] / light;
  return shares;
}

}  // namespace

DistanceWithSlopes wasserstein_distance(const SmoothGrid& grid, std::span<const double> f, std::span<const double> g) {
  const LightMoments found = light_moments(grid, f), wanted = light_moments(grid, g);
  const std::vector<double> from = light_shares(grid, f, found.light), to = light_shares(grid, g, wanted.light);
  // The mean over axes of a square is half of the trace's; a lobe of a single bin has the width of a bin.
  const double bin = 2.0 / static_cast<double>(grid.grid().width);
  const double unit = 0.5 * wanted.covariance.trace() + bin * bin / 12.0;
  std::vector<double> potential(f.size(), 0.0);
  double cost = 0.0;
  for (std::size_t k = 0; k < axes; ++k)
    cost += transport(line_along(grid.grid(), std::numbers::pi * static_cast<double>(k) / axes), from, to, potential);
  double mean = 0.0;
  for (std::size_t k = 0; k < f.size(); ++k) mean += from[k] * potential[k];
  const double brighter = std::log(found.light / wanted.light);
  DistanceWithSlopes result{cost / (axes * unit) + brighter * brighter, std::vector<double>(f.size())};
  for (std::size_t k = 0; k < f.size(); ++k) {
    result.slopes[k] = grid.areas()[k] / found.light * ((potential[k] - mean) / (axes * unit) + 2.0 * brighter);
  }
  return result;
}

}  // namespace mezzotint
