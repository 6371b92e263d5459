#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "forward/base/error.h"
#include "forward/optics/direction_map.h"

namespace mezzotint {

namespace {

// Sums over the bins of the disc; a bin outside of it has no area and may hold anything.
struct DifferenceSums {
  double squares = 0.0;         // Σ a (f − g)²
  double products = 0.0;        // Σ a (f_a − g_a)(f_b − g_b): the noise of the halves is independent
  double reference = 0.0;       // Σ a g²
  double reference_free = 0.0;  // Σ a g_a g_b
  double noise = 0.0;           // Σ a (σ_f² + σ_g²)
};

void require_bins(const DirectionGrid& grid, const DirectionMap& map) {
  require(map.size() == grid.size(), "a direction map has " + std::to_string(map.size()) + " values, its grid " +
                                         std::to_string(grid.size()) + " bins");
}

void require_bins(const DirectionGrid& grid, const MapEstimate& map) {
  require_bins(grid, map.mean);
  require_bins(grid, map.standard_error);
  require_bins(grid, map.half_a);
  require_bins(grid, map.half_b);
}

double square(double x) { return x * x; }

// Variance of the corrected square Q/G, by the delta method. With d = f − g, σ the standard error of a
// mean and halves that are independent (so of variance 2σ² each), the error of one product
// (f_a − g_a)(f_b − g_b) is 2d·δ plus a product of two noises: variance 4 d² σ² + 4 σ⁴. The square of
// the difference of the means has expectation d² + σ², so 4 σ² times it is that variance, estimated
// without bias. The noise of the reference enters G = Σ a g_a g_b too, by 2 g·δ_g: its share has
// d + (Q/G) g in place of d. Bins are taken as independent: those of a histogram are so nearly.
double variance_of_ratio(const std::vector<double>& areas, const MapEstimate& f, const MapEstimate& g, double ratio,
                         double denominator) {
  double sum = 0.0;
  for (std::size_t k = 0; k < areas.size(); ++k) {
    if (areas[k] <= 0.0) continue;
    const double difference = f.mean[k] - g.mean[k];
    sum += square(areas[k]) *
           (square(difference * f.standard_error[k]) + square((difference + ratio * g.mean[k]) * g.standard_error[k]));
  }
  return 4.0 * sum / square(denominator);
}

DifferenceSums sums_over_disc(const std::vector<double>& areas, const MapEstimate& f, const MapEstimate& g) {
  DifferenceSums sums;
  for (std::size_t k = 0; k < areas.size(); ++k) {
    if (areas[k] <= 0.0) continue;
    sums.squares += areas[k] * square(f.mean[k] - g.mean[k]);
    sums.products += areas[k] * (f.half_a[k] - g.half_a[k]) * (f.half_b[k] - g.half_b[k]);
    sums.reference += areas[k] * square(g.mean[k]);
    sums.reference_free += areas[k] * g.half_a[k] * g.half_b[k];
    sums.noise += areas[k] * (square(f.standard_error[k]) + square(g.standard_error[k]));
  }
  return sums;
}

// Half of the range of roots that one standard error to either side leaves: σ/(2√x) where x is well above
// its noise (the delta method), and √σ/2, not infinity, at 0, where the spread of the clamped root is .48 √σ.
Estimate root(double squared, double standard_error) {
  const double upper = std::sqrt(std::max(0.0, squared) + standard_error);
  const double lower = std::sqrt(std::max(0.0, squared - standard_error));
  return {std::sqrt(std::max(0.0, squared)), 0.5 * (upper - lower)};
}

MapEstimate as_estimate(const DirectionMap& exact) { return {exact, DirectionMap(exact.size(), 0.0), exact, exact}; }

}  // namespace

MapDifference relative_l2(const DirectionGrid& grid, const MapEstimate& f, const MapEstimate& g) {
  require_valid(grid);
  require_bins(grid, f);
  require_bins(grid, g);
  const std::vector<double> areas = projected_solid_angles(grid);
  const DifferenceSums sums = sums_over_disc(areas, f, g);
  require(sums.reference > 0.0, "the reference of a relative difference is zero in every bin of the disc");
  require(sums.reference_free > 0.0, "the reference of a relative difference is lost in its noise; trace it longer");
  const double ratio = sums.products / sums.reference_free;
  const double variance = variance_of_ratio(areas, f, g, ratio, sums.reference_free);
  return {root(ratio, std::sqrt(variance)), std::sqrt(sums.squares / sums.reference),
          std::sqrt(sums.noise / sums.reference_free)};
}

MapDifference relative_l2(const DirectionGrid& grid, const MapEstimate& f, const DirectionMap& g) {
  require_valid(grid);
  require_bins(grid, g);
  return relative_l2(grid, f, as_estimate(g));
}

double relative_l2(const DirectionGrid& grid, const DirectionMap& f, const DirectionMap& g) {
  require_valid(grid);
  require_bins(grid, f);
  return relative_l2(grid, as_estimate(f), g).plain;
}

}  // namespace mezzotint
