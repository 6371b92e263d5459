#include "measurement/reflectance/half_angle_table.h"

#include <algorithm>

namespace mezzotint {

namespace {

std::size_t bin(double share, std::size_t bins) {
  const double count = static_cast<double>(bins);
  return static_cast<std::size_t>(std::clamp(std::floor(share * count), 0.0, count - 1.0));
}

}  // namespace

HalfDifference half_difference(const Direction& to_light, const Direction& to_viewer) {
  const Direction half = (to_light + to_viewer).normalized();
  const double sine = std::hypot(half.x(), half.y());
  // Azimuth of the half vector; where it is the normal, any will do for an isotropic sample.
  const double cos_phi = sine > 0.0 ? half.x() / sine : 1.0, sin_phi = sine > 0.0 ? half.y() / sine : 0.0;
  // The light, turned by −φ about z and by −θ about y, which takes the half vector to z.
  const double x = cos_phi * to_light.x() + sin_phi * to_light.y();
  const double y = cos_phi * to_light.y() - sin_phi * to_light.x();
  const double dx = half.z() * x - sine * to_light.z(), dz = sine * x + half.z() * to_light.z();
  return {std::atan2(sine, half.z()), std::atan2(std::hypot(dx, y), dz), std::atan2(y, dx)};
}

double evaluate(const HalfAngleTable& table, const Direction& to_light, const Direction& to_viewer,
                const ChannelWeights& weights) {
  constexpr double pi = std::numbers::pi;
  const HalfDifference angles = half_difference(to_light, to_viewer);
  const double phi = angles.phi_difference < 0.0 ? angles.phi_difference + pi : angles.phi_difference;
  const std::size_t half = bin(std::sqrt(angles.theta_half / (pi / 2.0)), HalfAngleTable::half_angles);
  const std::size_t difference = bin(angles.theta_difference / (pi / 2.0), HalfAngleTable::difference_angles);
  const std::size_t azimuth = bin(phi / pi, HalfAngleTable::azimuths);
  const std::size_t index =
      (half * HalfAngleTable::difference_angles + difference) * HalfAngleTable::azimuths + azimuth;
  WeightedSum sum;
  for (std::size_t c = 0; c < weights.size(); ++c)
    sum.add(weights[c], double{table.values[c * HalfAngleTable::channel_size + index]});
  return sum.value();
}

}  // namespace mezzotint
