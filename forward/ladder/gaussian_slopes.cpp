#include "forward/ladder/gaussian_slopes.h"

#include <cmath>

#include <fmt/format.h>

#include "forward/surface/slope_covariance.h"

namespace mezzotint {

namespace {

constexpr double harmless_excess = 0.2;

struct Kurtosis {
  double major = 3.0, minor = 3.0;
};

Kurtosis slope_kurtosis(const HeightField& field, const SlopeAxes& axes) {
  double count = 0.0, mean_x = 0.0, mean_y = 0.0;
  for_each_facet_slope(field, [&](double a, double b) {
    count += 1.0;
    mean_x += a;
    mean_y += b;
  });
  mean_x /= count;
  mean_y /= count;
  const double cosine = std::cos(axes.rotation.radians()), sine = std::sin(axes.rotation.radians());
  double fourth_major = 0.0, fourth_minor = 0.0;
  for_each_facet_slope(field, [&](double a, double b) {
    const double x = a - mean_x, y = b - mean_y;
    fourth_major += std::pow(cosine * x + sine * y, 4.0);
    fourth_minor += std::pow(cosine * y - sine * x, 4.0);
  });
  const auto ratio = [&](double fourth, double rms) { return fourth / count / std::pow(rms, 4.0); };
  // An axis along which nothing rises has no shape.
  const bool flat_minor = axes.rms_minor < 1e-3 * axes.rms_major;
  return {ratio(fourth_major, axes.rms_major), flat_minor ? 3.0 : ratio(fourth_minor, axes.rms_minor)};
}

}  // namespace

std::vector<std::string> gaussian_slopes_warnings(const HeightField& field) {
  const SlopeAxes axes = principal_axes(slope_covariance(field));
  if (!(axes.rms_major > 0.0)) return {};
  const Kurtosis kurtosis = slope_kurtosis(field, axes);
  if (std::abs(kurtosis.major - 3.0) <= harmless_excess && std::abs(kurtosis.minor - 3.0) <= harmless_excess) return {};
  return {
      fmt::format("the slopes are not Gaussian (kurtosis {:.2f} and {:.2f} along their axes, 3 for a Gaussian): a "
                  "Beckmann lobe has another shape; --model slopes takes them as they are",
                  kurtosis.major, kurtosis.minor)};
}

}  // namespace mezzotint
