#include <algorithm>
#include <cmath>
#include <numbers>

#include "forward/base/error.h"
#include "forward/bsdf_table/adaptive_map.h"

namespace mezzotint {

namespace {

// Sums over the bins of a block, from which its mean, its noise and its spread follow.
struct BlockSums {
  double area = 0.0, value = 0.0, variance = 0.0;
  double half_a = 0.0, half_b = 0.0, products = 0.0;

  void add(double a, double f, double error, double f_a, double f_b) {
    area += a;
    value += a * f;
    variance += a * a * error * error;
    half_a += a * f_a;
    half_b += a * f_b;
    products += a * f_a * f_b;
  }
  /// Σ a (f − mean)², without noise in expectation.
  [[nodiscard]] double spread() const { return area > 0.0 ? products - half_a * half_b / area : 0.0; }
};

class BinJoiner {
public:
  BinJoiner(const DirectionGrid& grid, const MapEstimate& map, double tolerance)
      : grid_(grid), map_(map), areas_(projected_solid_angles(grid)), tolerance_(tolerance) {
    whole_ = sums_of(0, 0, AdaptiveMap::levels_of(grid));
    for (std::size_t k = 0; k < areas_.size(); ++k) clipped_ += areas_[k] * std::max(0.0, -map.mean[k]);
  }

  JoinedMap join() {
    JoinedMap joined;
    if (!(whole_.value > 0.0)) return joined;
    const auto values = [&](double scale) {
      return AdaptiveMap(grid_, areas_, [&, scale](std::size_t x, std::size_t y, unsigned level) {
        return square_of(x, y, level, scale);
      });
    };
    joined.map = values(1.0);
    // Squares that were clipped to 0 have left too much in the others.
    if (joined.map.integral() > 0.0 && clipped_ > 0.0) joined.map = values(whole_.value / joined.map.integral());
    joined.difference = whole_.products > 0.0 ? std::sqrt(std::max(0.0, spread_) / whole_.products) : 0.0;
    joined.clipped_share = clipped_ / whole_.value;
    return joined;
  }

private:
  [[nodiscard]] BlockSums sums_of(std::size_t x, std::size_t y, unsigned level) const {
    BlockSums sums;
    const std::size_t side = std::size_t{1} << level;
    for (std::size_t row = y; row < std::min(y + side, grid_.height); ++row) {
      for (std::size_t column = x; column < std::min(x + side, grid_.width); ++column) {
        const std::size_t k = row * grid_.width + column;
        if (areas_[k] <= 0.0) continue;
        sums.add(areas_[k], map_.mean[k], map_.standard_error[k], map_.half_a[k], map_.half_b[k]);
      }
    }
    return sums;
  }

  std::optional<AdaptiveMap::Square> square_of(std::size_t x, std::size_t y, unsigned level, double scale) {
    if (level == AdaptiveMap::levels_of(grid_)) spread_ = 0.0;  // from the root on again
    const BlockSums sums = sums_of(x, y, level);
    const double energy = std::max(0.0, whole_.products) * sums.area / std::numbers::pi;
    const double allowed = 0.5 * tolerance_ * tolerance_ * (energy + std::max(0.0, sums.products));
    if (level > 0 && sums.spread() > allowed) return std::nullopt;
    if (!(sums.area > 0.0)) return AdaptiveMap::Square{0.0F, 0.0F, level};
    if (level > 0) spread_ += sums.spread();
    const double mean = std::max(0.0, scale * sums.value / sums.area);
    return AdaptiveMap::Square{static_cast<float>(mean), static_cast<float>(std::sqrt(sums.variance) / sums.area),
                               level};
  }

  DirectionGrid grid_;
  const MapEstimate& map_;
  std::vector<double> areas_;
  double tolerance_;
  BlockSums whole_;
  double clipped_ = 0.0, spread_ = 0.0;
};

}  // namespace

JoinedMap join_smooth_bins(const DirectionGrid& grid, const MapEstimate& map, double tolerance) {
  require_valid(grid);
  for (const DirectionMap* values : {&map.mean, &map.standard_error, &map.half_a, &map.half_b}) {
    require(values->size() == grid.size(), "a direction map does not fit its grid");
    for (const double value : *values) require(std::isfinite(value), "a direction map holds a value that is no number");
  }
  require(tolerance >= 0.0 && tolerance < 1.0, "the tolerance of joining bins lies in [0, 1)");
  return BinJoiner(grid, map, tolerance).join();
}

}  // namespace mezzotint
