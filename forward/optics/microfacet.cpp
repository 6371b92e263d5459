#include "forward/optics/microfacet.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "forward/optics/lit_lobe.h"

namespace mezzotint {

namespace {

double beckmann_lambda(double a) {
  const double root_pi = std::sqrt(std::numbers::pi);
  // Both terms fall as exp(−a²) and cancel to a few parts of them: the rest may come out below 0 by rounding.
  return std::max(0.0, 0.5 * (std::exp(-a * a) / (a * root_pi) - std::erfc(a)));
}

double ggx_lambda(double a) {
  const double over = 1.0 / (a * a);
  return 0.5 * over / (1.0 + std::sqrt(1.0 + over));  // (√(1 + x) − 1)/2 without loss of digits at a small x
}

struct LobeName {
  const char* operator()(const BeckmannLobe&) const { return "Beckmann"; }
  const char* operator()(const GgxLobe&) const { return "GGX"; }
};

}  // namespace

void require_valid(const MicrofacetLobe& lobe) {
  const char* name = std::visit(LobeName{}, lobe);
  const auto check = [&](const auto& kind) {
    for (const double alpha : {kind.alpha_x, kind.alpha_y}) {
      require(alpha >= 1e-4 && alpha <= 4.0, fmt::format("a {} lobe has alphas from 0.0001 to 4, not {}", name, alpha));
    }
    require(std::isfinite(kind.rotation.radians()),
            fmt::format("the rotation of a {} lobe is not a finite number", name));
  };
  std::visit(check, lobe);
}

LobeFrame::LobeFrame(const MicrofacetLobe& lobe)
    : shape_(std::holds_alternative<GgxLobe>(lobe) ? Shape::Ggx : Shape::Beckmann) {
  const auto take = [this](const auto& kind) {
    alpha_x_ = kind.alpha_x;
    alpha_y_ = kind.alpha_y;
    cosine_ = std::cos(kind.rotation.radians());
    sine_ = std::sin(kind.rotation.radians());
  };
  std::visit(take, lobe);
}

double LobeFrame::distribution(const Direction& normal) const {
  if (normal.z() <= 0.0) return 0.0;
  const double z_squared = normal.z() * normal.z(), slope_squared = scaled_slope(normal).squaredNorm();
  const double fall =
      shape_ == Shape::Beckmann ? std::exp(-slope_squared) : 1.0 / ((1.0 + slope_squared) * (1.0 + slope_squared));
  return fall / (std::numbers::pi * alpha_x_ * alpha_y_ * z_squared * z_squared);
}

double LobeFrame::smooth_over(double slope) const {
  constexpr double at_the_peak = 0.7;
  if (shape_ == Shape::Ggx) return at_the_peak * std::sqrt(1.0 + slope * slope);  // tails without a scale
  // exp(−25) = 1e-11 of the peak: what lies further out is evaluated, but not refined.
  return slope < 5.0 ? at_the_peak : std::numeric_limits<double>::infinity();
}

double LobeFrame::smith_lambda(const Direction& direction) const {
  const double along = alpha_x_ * (cosine_ * direction.x() + sine_ * direction.y());
  const double across = alpha_y_ * (cosine_ * direction.y() - sine_ * direction.x());
  const double tilt = std::hypot(along, across);  // α(φ) sin θ
  if (!(tilt > 0.0)) return 0.0;
  const double a = std::abs(direction.z()) / tilt;
  return shape_ == Shape::Beckmann ? beckmann_lambda(a) : ggx_lambda(a);
}

LitLobe::LitLobe(const MicrofacetLobe& lobe, const Material& material, const Direction& to_light)
    : frame_(lobe), material_(material), to_light_(to_light), lambda_light_(frame_.smith_lambda(to_light)) {}

double LitLobe::brdf(const Direction& to_viewer) const {
  if (to_light_.z() <= 0.0 || to_viewer.z() <= 0.0) return 0.0;
  const Direction normal = (to_light_ + to_viewer).normalized();
  const double masking = 1.0 / (1.0 + lambda_light_ + frame_.smith_lambda(to_viewer));
  return reflectance(material_, normal.dot(to_light_)) * frame_.distribution(normal) * masking /
         (4.0 * to_light_.z() * to_viewer.z());
}

double distribution(const MicrofacetLobe& lobe, const Direction& normal) {
  return LobeFrame(lobe).distribution(normal);
}

double smith_lambda(const MicrofacetLobe& lobe, const Direction& direction) {
  return LobeFrame(lobe).smith_lambda(direction);
}

double brdf(const MicrofacetLobe& lobe, const Material& material, const Direction& to_light,
            const Direction& to_viewer) {
  return LitLobe(lobe, material, to_light).brdf(to_viewer);
}

}  // namespace mezzotint
