#include "inverse/objective/smooth_lobe.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <tbb/parallel_for.h>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

constexpr std::size_t reflectance_steps = 2048;
constexpr std::size_t parts = 32;

// Value and slope of a curve at even steps over [0, 1], by Catmull and Rom's cubic: continuous slopes.
struct CurvePoint {
  double value, slope;
};
CurvePoint on_curve(const std::vector<double>& nodes, double x) {
  const double at = x * reflectance_steps;
  const auto cell = std::min(static_cast<std::size_t>(at), reflectance_steps - 1);
  const double t = at - static_cast<double>(cell);
  // nodes[0] stands one step before the first one.
  const double p0 = nodes[cell], p1 = nodes[cell + 1], p2 = nodes[cell + 2], p3 = nodes[cell + 3];
  const double a = 0.5 * (3.0 * (p1 - p2) + p3 - p0), b = p0 - 2.5 * p1 + 2.0 * p2 - 0.5 * p3, c = 0.5 * (p2 - p0);
  return {((a * t + b) * t + c) * t + p1, ((3.0 * a * t + 2.0 * b) * t + c) * reflectance_steps};
}

// One step beyond either end by a parabola through the nearest three.
std::vector<double> reflectance_nodes(const Material& material) {
  std::vector<double> nodes(reflectance_steps + 3);
  for (std::size_t i = 0; i <= reflectance_steps; ++i)
    nodes[i + 1] = reflectance(material, static_cast<double>(i) / reflectance_steps);
  nodes.front() = 3.0 * (nodes[1] - nodes[2]) + nodes[3];
  nodes.back() = 3.0 * (nodes[reflectance_steps + 1] - nodes[reflectance_steps]) + nodes[reflectance_steps - 1];
  return nodes;
}

// Parts of all points, each summed by itself: the same order with any number of threads.
struct Part {
  std::size_t first, count;
};
Part part_of(std::size_t index, std::size_t points) {
  const std::size_t first = index * points / parts;
  return {first, (index + 1) * points / parts - first};
}

// A map's value and slopes between its bins.
struct MapPoint {
  double value = 0.0, along_u = 0.0, along_v = 0.0;
};
MapPoint at_soft_bins(const std::vector<double>& map, std::size_t width, const SoftBins& u, const SoftBins& v) {
  MapPoint at;
  for (std::size_t j = 0; j < 3; ++j) {
    const double* const line = map.data() + v.bin[j] * width;
    double across = 0.0, slope = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      across += u.share[i] * line[u.bin[i]];
      slope += u.slope[i] * line[u.bin[i]];
    }
    at.value += v.share[j] * across;
    at.along_u += v.share[j] * slope;
    at.along_v += v.slope[j] * across;
  }
  return at;
}

void require_points(std::span<const float> slopes_x, std::span<const float> slopes_y) {
  require(!slopes_x.empty() && slopes_x.size() == slopes_y.size(), "a lobe needs two slopes a point, and a point");
  float sum = 0.0F;  // NaN as soon as one of them is not finite
  for (std::size_t i = 0; i < slopes_x.size(); ++i) sum += 0.0F * (slopes_x[i] + slopes_y[i]);
  require(sum == 0.0F, "slopes must be finite; fill missing samples first");
}

}  // namespace

// What a facet of a slope sends where, with the slopes of all three toward its own two.
struct SmoothLobe::Sent {
  double weight = 0.0, x = 0.0, y = 0.0;
  double weight_p = 0.0, weight_q = 0.0, x_p = 0.0, x_q = 0.0, y_p = 0.0, y_q = 0.0;
};

SmoothLobe::SmoothLobe(const SmoothGrid& grid, const Material& material, const DirectionAngles& to_light)
    : grid_(grid), to_light_(to_direction(to_light)), reflectance_(reflectance_nodes(material)) {
  const double theta = to_light.theta.radians();
  require(theta >= 0.0 && theta < 0.5 * std::numbers::pi && std::isfinite(to_light.phi.radians()),
          "the light stands above the horizon: theta from 0 to less than 90 degrees");
}

// With slopes p, q: m = (−p, −q, 1)/n, s = n·(ω_i·m), ω_o = 2 s/n² (−p, −q, 1) − ω_i, weight F(s/n)·s/cosθ_i.
SmoothLobe::Sent SmoothLobe::sent(double p, double q) const {
  const double ix = to_light_.x(), iy = to_light_.y(), iz = to_light_.z();
  const double square = 1.0 + p * p + q * q, s = iz - p * ix - q * iy;
  if (s <= 0.0 || 2.0 * s / square <= iz) return {};  // turned away from the light, or sent downward
  const double n = std::sqrt(square), cosine = std::min(1.0, s / n);
  const CurvePoint fresnel = on_curve(reflectance_, cosine);
  const double k = 2.0 * s / square, k2 = 2.0 * k / square;
  const double cosine_p = -ix / n - s * p / (n * square), cosine_q = -iy / n - s * q / (n * square);
  Sent out;
  out.weight = fresnel.value * s / iz;
  out.weight_p = (fresnel.slope * cosine_p * s - fresnel.value * ix) / iz;
  out.weight_q = (fresnel.slope * cosine_q * s - fresnel.value * iy) / iz;
  out.x = -k * p - ix;
  out.y = -k * q - iy;
  out.x_p = 2.0 * ix * p / square - k + k2 * p * p;
  out.x_q = 2.0 * iy * p / square + k2 * p * q;
  out.y_p = 2.0 * ix * q / square + k2 * p * q;
  out.y_q = 2.0 * iy * q / square - k + k2 * q * q;
  return out;
}

void SmoothLobe::add_light(std::span<const float> slopes_x, std::span<const float> slopes_y,
                           std::vector<double>& light) const {
  const DirectionGrid& bins = grid_.grid();
  const double bins_x = 0.5 * static_cast<double>(bins.width), bins_y = 0.5 * static_cast<double>(bins.height);
  for (std::size_t point = 0; point < slopes_x.size(); ++point) {
    const Sent s = sent(slopes_x[point], slopes_y[point]);
    if (s.weight == 0.0) continue;
    const SoftBins u = soft_bins(bins_x * (s.x + 1.0), bins.width), v = soft_bins(bins_y * (s.y + 1.0), bins.height);
    for (std::size_t j = 0; j < 3; ++j) {
      double* const line = light.data() + v.bin[j] * bins.width;
      for (std::size_t i = 0; i < 3; ++i) line[u.bin[i]] += s.weight * v.share[j] * u.share[i];
    }
  }
}

DirectionMap SmoothLobe::map(std::span<const float> slopes_x, std::span<const float> slopes_y) const {
  require_points(slopes_x, slopes_y);
  std::vector<std::vector<double>> lights(parts, std::vector<double>(grid_.grid().size(), 0.0));
  tbb::parallel_for(std::size_t{0}, parts, [&](std::size_t index) {
    const Part part = part_of(index, slopes_x.size());
    add_light(slopes_x.subspan(part.first, part.count), slopes_y.subspan(part.first, part.count), lights[index]);
  });
  DirectionMap map(grid_.grid().size(), 0.0);
  const auto points = static_cast<double>(slopes_x.size());
  for (std::size_t k = 0; k < map.size(); ++k) {
    for (const auto& light : lights) map[k] += light[k];
    map[k] = grid_.areas()[k] > 0.0 ? map[k] / (points * grid_.areas()[k]) : 0.0;
  }
  return map;
}

void SmoothLobe::add_slope_derivatives(std::span<const float> slopes_x, std::span<const float> slopes_y,
                                       std::span<const double> map_derivatives, double share, std::span<float> toward_x,
                                       std::span<float> toward_y) const {
  require_points(slopes_x, slopes_y);
  require(map_derivatives.size() == grid_.grid().size(), "one derivative a bin is needed");
  require(toward_x.size() == slopes_x.size() && toward_y.size() == slopes_x.size(), "room for one derivative a slope");
  const DirectionGrid& bins = grid_.grid();
  const double bins_x = 0.5 * static_cast<double>(bins.width), bins_y = 0.5 * static_cast<double>(bins.height);
  std::vector<double> value_of_light(bins.size(), 0.0);
  for (std::size_t k = 0; k < bins.size(); ++k) {
    if (grid_.areas()[k] > 0.0)
      value_of_light[k] = share * map_derivatives[k] / (static_cast<double>(slopes_x.size()) * grid_.areas()[k]);
  }
  tbb::parallel_for(std::size_t{0}, parts, [&](std::size_t index) {
    const Part part = part_of(index, slopes_x.size());
    for (std::size_t point = part.first; point < part.first + part.count; ++point) {
      const Sent s = sent(slopes_x[point], slopes_y[point]);
      if (s.weight == 0.0) continue;
      const SoftBins u = soft_bins(bins_x * (s.x + 1.0), bins.width), v = soft_bins(bins_y * (s.y + 1.0), bins.height);
      const auto [value, along_u, along_v] = at_soft_bins(value_of_light, bins.width, u, v);
      const double toward_u = s.weight * along_u * bins_x, toward_v = s.weight * along_v * bins_y;
      toward_x[point] += static_cast<float>(s.weight_p * value + toward_u * s.x_p + toward_v * s.y_p);
      toward_y[point] += static_cast<float>(s.weight_q * value + toward_u * s.x_q + toward_v * s.y_q);
    }
  });
}

}  // namespace mezzotint
