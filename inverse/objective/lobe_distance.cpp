#include "inverse/objective/lobe_distance.h"

#include <algorithm>
#include <cmath>

#include "forward/base/error.h"
#include "inverse/objective/light_moments.h"
#include "inverse/objective/sliced_wasserstein.h"

namespace mezzotint {

namespace {

double square(double value) { return value * value; }

// Σ a (u(f) − u(g))² / Σ a u(g)² for a curve u, given with its slope.
template <class Curve>
DistanceWithSlopes of_curve(std::span<const double> areas, std::span<const double> f, std::span<const double> g,
                            const Curve& curve) {
  DistanceWithSlopes result{0.0, std::vector<double>(f.size(), 0.0)};
  double whole = 0.0;
  for (std::size_t k = 0; k < f.size(); ++k) {
    const auto [found, slope] = curve(f[k]);
    const double wanted = curve(g[k]).first;
    result.value += areas[k] * square(found - wanted);
    result.slopes[k] = 2.0 * areas[k] * (found - wanted) * slope;
    whole += areas[k] * square(wanted);
  }
  result.value /= whole;
  for (double& slope : result.slopes) slope /= whole;
  return result;
}

void require_lobe(const SmoothGrid& grid, std::span<const double> lobe) {
  require(lobe.size() == grid.grid().size(), "a lobe of another grid");
  double light = 0.0;
  for (std::size_t k = 0; k < lobe.size(); ++k) {
    require(std::isfinite(lobe[k]) && lobe[k] >= 0.0, "a lobe's values must be finite and not negative");
    light += grid.areas()[k] * lobe[k];
  }
  require(light > 0.0, "a lobe that is dark everywhere has no distance to another");
}

}  // namespace

std::string_view name_of(LobeDistance distance) {
  switch (distance) {
    case LobeDistance::L2:
      return "l2";
    case LobeDistance::CubeRoot:
      return "cube_root";
    case LobeDistance::Logarithm:
      return "log";
    case LobeDistance::Wasserstein:
      return "sliced_wasserstein";
    case LobeDistance::Moments:
      break;
  }
  return "moments";
}

DistanceWithSlopes lobe_distance(LobeDistance distance, const SmoothGrid& grid, std::span<const double> f,
                                 std::span<const double> g) {
  require_lobe(grid, f);
  require_lobe(grid, g);
  const double peak = *std::ranges::max_element(g), little = 1e-6 * peak, flank = 0.01 * peak;
  using Point = std::pair<double, double>;
  switch (distance) {
    case LobeDistance::L2:
      return of_curve(grid.areas(), f, g, [](double x) { return Point{x, 1.0}; });
    case LobeDistance::CubeRoot:
      return of_curve(grid.areas(), f, g, [little](double x) {
        const double root = std::cbrt(x + little);
        return Point{root, 1.0 / (3.0 * root * root)};
      });
    case LobeDistance::Logarithm:
      return of_curve(grid.areas(), f, g, [flank](double x) {
        return Point{std::log1p(x / flank), 1.0 / (flank + x)};
      });
    case LobeDistance::Wasserstein:
      return wasserstein_distance(grid, f, g);
    case LobeDistance::Moments:
      break;
  }
  return moment_distance(grid, f, g);
}

}  // namespace mezzotint
