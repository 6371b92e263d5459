#include "measurement/texture/normal_distribution.h"

#include <algorithm>
#include <cmath>

namespace mezzotint {

namespace {

struct Moments {
  double count = 0.0, x = 0.0, y = 0.0;
};

Moments mean_slopes(const HeightField& field) {
  Moments sums;
  for_each_facet_slope(field, [&](double x, double y) {
    sums.count += 1.0;
    sums.x += x;
    sums.y += y;
  });
  return {sums.count, sums.x / sums.count, sums.y / sums.count};
}

double kurtosis(double fourth, double second, double count) { return count * fourth / (second * second); }

}  // namespace

NormalDistribution normal_distribution(const HeightField& field, const DirectionGrid& grid) {
  require_valid(grid);
  const Grid& samples = field.grid();
  NormalDistribution result{grid, DirectionMap(grid.size(), 0.0), principal_axes(slope_covariance(field))};
  const Moments mean = mean_slopes(field);
  const double c = std::cos(result.axes.rotation.radians()), s = std::sin(result.axes.rotation.radians());
  double second_u = 0.0, fourth_u = 0.0, second_v = 0.0, fourth_v = 0.0;
  for_each_facet_slope(field, [&](double x, double y) {
    const double per_length = 1.0 / std::sqrt(1.0 + x * x + y * y);
    result.distribution[grid.bin_of(-x * per_length, -y * per_length)] += 1.0 / mean.count;
    const double u = c * (x - mean.x) + s * (y - mean.y), v = c * (y - mean.y) - s * (x - mean.x);
    second_u += u * u;
    fourth_u += u * u * u * u;
    second_v += v * v;
    fourth_v += v * v * v * v;
  });
  const std::vector<double> areas = projected_solid_angles(grid);
  for (std::size_t bin = 0; bin < areas.size(); ++bin)
    result.distribution[bin] = areas[bin] > 0.0 ? result.distribution[bin] / areas[bin] : 0.0;
  result.kurtosis_major = kurtosis(fourth_u, second_u, mean.count);
  result.kurtosis_minor = kurtosis(fourth_v, second_v, mean.count);
  result.shortest_um = 2.0 * std::max(samples.pitch_x.um(), samples.pitch_y.um());
  result.longest_um = std::max(samples.pitch_x.um() * static_cast<double>(samples.columns),
                               samples.pitch_y.um() * static_cast<double>(samples.rows));
  return result;
}

}  // namespace mezzotint
