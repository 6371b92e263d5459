#include "measurement/texture/normal_distribution.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "measurement/texture/block_jackknife.h"
#include "measurement/texture/blocks.h"

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

/// Sums of even powers of the slopes along their own axes.
struct Powers {
  double count = 0.0, second_u = 0.0, fourth_u = 0.0, second_v = 0.0, fourth_v = 0.0;

  void add(double u, double v) {
    count += 1.0;
    second_u += u * u;
    fourth_u += u * u * u * u;
    second_v += v * v;
    fourth_v += v * v * v * v;
  }
  [[nodiscard]] Powers without(const Powers& part) const {
    return {count - part.count, second_u - part.second_u, fourth_u - part.fourth_u, second_v - part.second_v,
            fourth_v - part.fourth_v};
  }
  [[nodiscard]] double kurtosis_u() const { return count * fourth_u / (second_u * second_u); }
  [[nodiscard]] double kurtosis_v() const { return count * fourth_v / (second_v * second_v); }
};

/// Turns slopes into those about the mean, along the axes.
struct Turn {
  Moments mean;
  double c = 1.0, s = 0.0;

  void add(Powers& powers, double x, double y) const {
    powers.add(c * (x - mean.x) + s * (y - mean.y), c * (y - mean.y) - s * (x - mean.x));
  }
};

// The blocks without the cells that join them, which are few.
std::array<Powers, block_count> powers_of_blocks(const HeightField& field, const Turn& turn) {
  std::array<Powers, block_count> blocks;
  const auto edge = [](std::size_t k, std::size_t count) { return k * count / blocks_a_side; };
  for (std::size_t block = 0; block < block_count; ++block) {
    const std::size_t bx = block % blocks_a_side, by = block / blocks_a_side;
    const std::size_t x = edge(bx, field.columns()), y = edge(by, field.rows());
    const std::size_t width = edge(bx + 1, field.columns()) - x, height = edge(by + 1, field.rows()) - y;
    if (width < 2 || height < 2) continue;
    for_each_facet_slope(crop(field, x, y, width, height),
                         [&](double dx, double dy) { turn.add(blocks[block], dx, dy); });
  }
  return blocks;
}

template <class Kurtosis>
Quantity estimate(const Powers& whole, const std::array<Powers, block_count>& blocks, const Kurtosis& kurtosis) {
  std::array<double, block_count> without{}, samples{};
  for (std::size_t j = 0; j < block_count; ++j) {
    without[j] = kurtosis(whole.without(blocks[j]));
    samples[j] = blocks[j].count;
  }
  return {kurtosis(whole), "1", jackknife_standard_error(kurtosis(whole), without, samples)};
}

}  // namespace

NormalDistribution normal_distribution(const HeightField& field, const DirectionGrid& grid) {
  require_valid(grid);
  const Grid& samples = field.grid();
  NormalDistribution result{grid, DirectionMap(grid.size(), 0.0), principal_axes(slope_covariance(field))};
  const Moments mean = mean_slopes(field);
  const Turn turn{mean, std::cos(result.axes.rotation.radians()), std::sin(result.axes.rotation.radians())};
  Powers powers;
  for_each_facet_slope(field, [&](double x, double y) {
    const double per_length = 1.0 / std::sqrt(1.0 + x * x + y * y);
    result.distribution[grid.bin_of(-x * per_length, -y * per_length)] += 1.0 / mean.count;
    turn.add(powers, x, y);
  });
  const std::vector<double> areas = projected_solid_angles(grid);
  for (std::size_t bin = 0; bin < areas.size(); ++bin)
    result.distribution[bin] = areas[bin] > 0.0 ? result.distribution[bin] / areas[bin] : 0.0;
  const std::array<Powers, block_count> blocks = powers_of_blocks(field, turn);
  result.kurtosis_major = estimate(powers, blocks, [](const Powers& p) { return p.kurtosis_u(); });
  result.kurtosis_minor = estimate(powers, blocks, [](const Powers& p) { return p.kurtosis_v(); });
  result.shortest_um = 2.0 * std::max(samples.pitch_x.um(), samples.pitch_y.um());
  result.longest_um = std::max(samples.pitch_x.um() * static_cast<double>(samples.columns),
                               samples.pitch_y.um() * static_cast<double>(samples.rows));
  return result;
}

}  // namespace mezzotint
