#include "measurement/reflectance/polar_lobes.h"

#include <algorithm>

#include <Eigen/Geometry>

namespace mezzotint {

namespace {

constexpr double angle_slack = 1e-6;
constexpr double at_a_sample = 1e-9;

struct PolarAngles {
  double azimuth;
  double radial;
};

// Unit vectors of the plane across the axis: along `first` the azimuth is 0, along `second` 90°.
struct AxisFrame {
  Direction axis, first, second;
};

AxisFrame frame_of(PolarLobes::Axis axis, const DirectionAngles& light) {
  const double theta = light.theta.radians(), phi = light.phi.radians();
  const Direction toward(std::cos(phi), std::sin(phi), 0.0);  // of the light, in the plane
  const Direction normal = Direction::UnitZ();
  if (axis == PolarLobes::Axis::Normal) return {normal, -toward, normal.cross(-toward)};
  const Direction mirrored = std::cos(theta) * normal - std::sin(theta) * toward;
  const Direction up = std::cos(theta) * toward + std::sin(theta) * normal;
  return {mirrored, up, mirrored.cross(up)};
}

PolarAngles polar_angles(const AxisFrame& frame, const Direction& direction, bool symmetric) {
  const double x = direction.dot(frame.first), y = direction.dot(frame.second);
  const double radial = std::atan2(std::hypot(x, y), direction.dot(frame.axis));
  double azimuth = std::atan2(y, x);
  if (symmetric) azimuth = std::abs(azimuth);
  if (azimuth < 0.0) azimuth += 2.0 * std::numbers::pi;
  return {azimuth, radial};
}

double interpolated(const PolarLobe& lobe, const PolarAngles& angles, const ChannelWeights& weights) {
  const Place azimuth = place_among(lobe.azimuth_rad, angles.azimuth, angle_slack);
  const Place radial = place_among(lobe.radial_rad, angles.radial, angle_slack);
  if (!azimuth.known || !radial.known) return not_measured;
  const std::size_t columns = lobe.radial_rad.size(), size = columns * lobe.azimuth_rad.size();
  WeightedSum sum;
  for (std::size_t c = 0; c < weights.size(); ++c) {
    for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
      for (const std::size_t j : {std::size_t{0}, std::size_t{1}}) {
        const double weight =
            (i == 0 ? 1.0 - azimuth.share : azimuth.share) * (j == 0 ? 1.0 - radial.share : radial.share);
        if (weight == 0.0) continue;
        sum.add(weights[c] * weight, double{lobe.values[c * size + (azimuth.index + i) * columns + radial.index + j]});
      }
    }
  }
  return sum.value();
}

bool is_incidence(const PolarLobes& lobes, const PolarLobe& lobe, const DirectionAngles& light) {
  const double theta = std::abs(lobe.incidence.theta.radians() - light.theta.radians());
  const double phi = std::abs(wrapped(lobe.incidence.phi.radians() - light.phi.radians()));
  const double most = incidence_tolerance.radians();
  return theta <= most && (lobes.any_azimuth || light.theta.radians() < most || phi <= most);
}

}  // namespace

Place place_among(std::span<const double> increasing, double value, double slack) {
  if (increasing.empty() || !(value >= increasing.front() - slack && value <= increasing.back() + slack)) return {};
  if (increasing.size() == 1) return {0, 0.0, true};
  const auto above = std::upper_bound(increasing.begin() + 1, increasing.end() - 1, value);
  const auto index = static_cast<std::size_t>(above - increasing.begin()) - 1;
  const double low = increasing[index], high = increasing[index + 1];
  const double share = std::clamp((value - low) / (high - low), 0.0, 1.0);
  // A place at a sample asks nothing of the next one, which may be missing.
  return {index, share < at_a_sample ? 0.0 : (share > 1.0 - at_a_sample ? 1.0 : share), true};
}

double evaluate(const PolarLobes& lobes, const Direction& to_light, const Direction& to_viewer,
                const ChannelWeights& weights) {
  const DirectionAngles light = to_angles(to_light);
  const AxisFrame frame = frame_of(lobes.axis, light);
  const PolarAngles angles = polar_angles(frame, to_viewer, lobes.symmetric);
  for (const PolarLobe& lobe : lobes.lobes) {
    if (is_incidence(lobes, lobe, light)) return interpolated(lobe, angles, weights);
  }
  if (!lobes.between) return not_measured;
  std::vector<double> thetas;
  for (const PolarLobe& lobe : lobes.lobes) thetas.push_back(lobe.incidence.theta.radians());
  const Place place = place_among(thetas, light.theta.radians(), 0.0);
  if (!place.known || thetas.size() < 2) return not_measured;
  return (1.0 - place.share) * interpolated(lobes.lobes[place.index], angles, weights) +
         place.share * interpolated(lobes.lobes[place.index + 1], angles, weights);
}

}  // namespace mezzotint
