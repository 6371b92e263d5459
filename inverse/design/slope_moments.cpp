#include "inverse/design/slope_moments.h"

#include <array>
#include <cstddef>
#include <numeric>

namespace mezzotint {

namespace {

// Some at a time: each has sums of its own, so that none waits for another.
struct SlopeSums {
  static constexpr std::size_t lanes = 4;
  using Lanes = std::array<double, lanes>;
  Lanes x{}, y{}, xx{}, yy{}, xy{};

  void add(const float* slopes_x, const float* slopes_y, std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) {
      const double p = slopes_x[k], q = slopes_y[k];
      x[k] += p;
      y[k] += q;
      xx[k] += p * p;
      yy[k] += q * q;
      xy[k] += p * q;
    }
  }
  static double total(const Lanes& sums) { return std::accumulate(sums.begin(), sums.end(), 0.0); }
};

}  // namespace

SlopeMoments slope_moments(const ReliefSlopes& slopes) {
  SlopeSums sums;
  const std::size_t points = slopes.x.size();
  std::size_t i = 0;
  for (; i + SlopeSums::lanes <= points; i += SlopeSums::lanes)
    sums.add(slopes.x.data() + i, slopes.y.data() + i, SlopeSums::lanes);
  sums.add(slopes.x.data() + i, slopes.y.data() + i, points - i);
  const auto n = static_cast<double>(points);
  const double x = SlopeSums::total(sums.x) / n, y = SlopeSums::total(sums.y) / n;
  return {x,
          y,
          {SlopeSums::total(sums.xx) / n - x * x, SlopeSums::total(sums.yy) / n - y * y,
           SlopeSums::total(sums.xy) / n - x * y}};
}

}  // namespace mezzotint
