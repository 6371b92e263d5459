#include "forward/optics/microfacet.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "forward/optics/lit_lobe.h"

namespace mezzotint {

namespace {

double lambda_at(double a) {
  const double root_pi = std::sqrt(std::numbers::pi);
  // Both terms fall as exp(−a²) and cancel to a few parts of them: the rest may come out below 0 by rounding.
  return std::max(0.0, 0.5 * (std::exp(-a * a) / (a * root_pi) - std::erfc(a)));
}

}  // namespace

void require_valid(const BeckmannLobe& lobe) {
  for (const double alpha : {lobe.alpha_x, lobe.alpha_y}) {
    require(alpha >= 1e-4 && alpha <= 4.0, fmt::format("a Beckmann lobe has alphas from 0.0001 to 4, not {}", alpha));
  }
  require(std::isfinite(lobe.rotation.radians()), "the rotation of a Beckmann lobe is not a finite number");
}

LobeFrame::LobeFrame(const BeckmannLobe& lobe)
    : alpha_x_(lobe.alpha_x),
      alpha_y_(lobe.alpha_y),
      cosine_(std::cos(lobe.rotation.radians())),
      sine_(std::sin(lobe.rotation.radians())) {}

double LobeFrame::distribution(const Direction& normal) const {
  if (normal.z() <= 0.0) return 0.0;
  const double z_squared = normal.z() * normal.z();
  return std::exp(-scaled_slope(normal).squaredNorm()) /
         (std::numbers::pi * alpha_x_ * alpha_y_ * z_squared * z_squared);
}

double LobeFrame::smith_lambda(const Direction& direction) const {
  const double along = alpha_x_ * (cosine_ * direction.x() + sine_ * direction.y());
  const double across = alpha_y_ * (cosine_ * direction.y() - sine_ * direction.x());
  const double tilt = std::hypot(along, across);  // α(φ) sin θ
  return tilt > 0.0 ? lambda_at(std::abs(direction.z()) / tilt) : 0.0;
}

LitLobe::LitLobe(const BeckmannLobe& lobe, const Material& material, const Direction& to_light)
    : frame_(lobe), material_(material), to_light_(to_light), lambda_light_(frame_.smith_lambda(to_light)) {}

double LitLobe::brdf(const Direction& to_viewer) const {
  if (to_light_.z() <= 0.0 || to_viewer.z() <= 0.0) return 0.0;
  const Direction normal = (to_light_ + to_viewer).normalized();
  const double masking = 1.0 / (1.0 + lambda_light_ + frame_.smith_lambda(to_viewer));
  return reflectance(material_, normal.dot(to_light_)) * frame_.distribution(normal) * masking /
         (4.0 * to_light_.z() * to_viewer.z());
}

double distribution(const BeckmannLobe& lobe, const Direction& normal) { return LobeFrame(lobe).distribution(normal); }

double smith_lambda(const BeckmannLobe& lobe, const Direction& direction) {
  return LobeFrame(lobe).smith_lambda(direction);
}

double brdf(const BeckmannLobe& lobe, const Material& material, const Direction& to_light, const Direction& to_viewer) {
  return LitLobe(lobe, material, to_light).brdf(to_viewer);
}

}  // namespace mezzotint
