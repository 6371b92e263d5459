#include "measurement/reflectance/scattered_lobes.h"

#include <algorithm>

#include <fmt/format.h>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

// Directions nearer than this are one.
constexpr double same_place = 1e-7;

bool is_one_sided(const std::vector<ScatteredSample>& samples) {
  bool above = false, below = false;
  for (const ScatteredSample& sample : samples) {
    above = above || sample.place.y > 1e-4;
    below = below || sample.place.y < -1e-4;
  }
  return !(above && below);
}

std::int64_t rounded(double value, double step) { return std::llround(value / step); }

// Samples of one light and place are neighbours in this order.
void sort_by_place(std::vector<ScatteredSample>& samples) {
  const auto key = [](const ScatteredSample& sample) {
    return std::array{rounded(sample.theta_i.radians(), incidence_tolerance.radians()),
                      rounded(sample.place.x, same_place), rounded(sample.place.y, same_place)};
  };
  std::stable_sort(samples.begin(), samples.end(),
                   [&](const ScatteredSample& a, const ScatteredSample& b) { return key(a) < key(b); });
}

bool is_same_light(const ScatteredSample& a, const ScatteredSample& b) {
  return std::abs(a.theta_i.radians() - b.theta_i.radians()) <= incidence_tolerance.radians();
}

bool is_same_place(const PlanePoint& a, const PlanePoint& b) {
  return std::abs(a.x - b.x) <= 2.0 * same_place && std::abs(a.y - b.y) <= 2.0 * same_place;
}

ScatteredLobe lobe_of(std::span<const ScatteredSample> samples) {
  std::vector<PlanePoint> points;
  std::vector<float> values;
  for (std::size_t i = 0; i < samples.size();) {
    std::size_t end = i + 1;
    while (end < samples.size() && is_same_place(samples[i].place, samples[end].place)) ++end;
    points.push_back(samples[i].place);
    for (std::size_t c = 0; c < samples[i].values.size(); ++c) {
      double sum = 0.0;
      for (std::size_t k = i; k < end; ++k) sum += double{samples[k].values[c]};
      values.push_back(static_cast<float>(sum / static_cast<double>(end - i)));
    }
    i = end;
  }
  const double theta = samples.front().theta_i.degrees();
  require(points.size() >= 3, fmt::format("the light at {:.6g}° has {} directions of the viewer; interpolation needs "
                                          "three or more",
                                          theta, points.size()));
  require(points.size() <= Triangulation::most_points,
          fmt::format("the light at {:.6g}° has {} directions of the viewer; at most {} are read", theta, points.size(),
                      Triangulation::most_points));
  return {samples.front().theta_i, Triangulation(std::move(points)), std::move(values)};
}

}  // namespace

ScatteredLobes scattered_lobes(std::vector<ScatteredSample> samples) {
  ScatteredLobes result;
  result.symmetric = is_one_sided(samples);
  if (result.symmetric) {
    for (ScatteredSample& sample : samples) sample.place.y = std::abs(sample.place.y);
  }
  sort_by_place(samples);
  for (std::size_t i = 0; i < samples.size();) {
    std::size_t end = i + 1;
    while (end < samples.size() && is_same_light(samples[i], samples[end])) ++end;
    result.lobes.push_back(lobe_of(std::span(samples).subspan(i, end - i)));
    i = end;
  }
  return result;
}

double evaluate(const ScatteredLobes& lobes, const Direction& to_light, const Direction& to_viewer,
                const ChannelWeights& weights) {
  const DirectionAngles light = to_angles(to_light), viewer = to_angles(to_viewer);
  const double theta = viewer.theta.radians(), phi = viewer.phi.radians() - light.phi.radians();
  const double y = theta * std::sin(phi);
  const PlanePoint place{theta * std::cos(phi), lobes.symmetric ? std::abs(y) : y};
  for (const ScatteredLobe& lobe : lobes.lobes) {
    if (std::abs(lobe.theta_i.radians() - light.theta.radians()) > incidence_tolerance.radians()) continue;
    const auto corners = lobe.plane.around(place);
    if (!corners) return not_measured;
    WeightedSum sum;
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t c = 0; c < weights.size(); ++c)
        sum.add(weights[c] * corners->weight[k], double{lobe.values[corners->point[k] * weights.size() + c]});
    }
    return sum.value();
  }
  return not_measured;
}

}  // namespace mezzotint
