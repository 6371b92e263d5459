#include "forward/surface/slope_covariance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

struct SlopeSums {
  double x = 0.0, y = 0.0, xx = 0.0, yy = 0.0, xy = 0.0, count = 0.0;

  void add(double sx, double sy) {
    x += sx;
    y += sy;
    xx += sx * sx;
    yy += sy * sy;
    xy += sx * sy;
    count += 1.0;
  }
};

}  // namespace

SlopeAxes principal_axes(const SlopeCovariance& covariance) {
  const double mean = 0.5 * (covariance.xx + covariance.yy);
  const double half_difference = 0.5 * (covariance.xx - covariance.yy);
  const double radius = std::hypot(half_difference, covariance.xy);
  const double rotation = radius > 0.0 ? 0.5 * std::atan2(covariance.xy, half_difference) : 0.0;
  return {std::sqrt(std::max(0.0, mean + radius)), std::sqrt(std::max(0.0, mean - radius)),
          Angle::from_radians(rotation)};
}

SlopeCovariance covariance_of(const SlopeAxes& axes) {
  const double c = std::cos(axes.rotation.radians()), s = std::sin(axes.rotation.radians());
  const double major = axes.rms_major * axes.rms_major, minor = axes.rms_minor * axes.rms_minor;
  return {major * c * c + minor * s * s, major * s * s + minor * c * c, (major - minor) * c * s};
}

SlopeCovariance slope_covariance(const HeightField& field) {
  SlopeSums total;
  for_each_facet_slope(field, [&](double sx, double sy) { total.add(sx, sy); });
  require(total.count > 0.0, "no cell with four measured corners: the relief has no slopes");
  const double mean_x = total.x / total.count, mean_y = total.y / total.count;
  return {total.xx / total.count - mean_x * mean_x, total.yy / total.count - mean_y * mean_y,
          total.xy / total.count - mean_x * mean_y};
}

Angle axis_difference(Angle a, Angle b) {
  const double turned = std::fmod(std::abs(a.radians() - b.radians()), std::numbers::pi);
  return Angle::from_radians(std::min(turned, std::numbers::pi - turned));
}

}  // namespace mezzotint
