#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>

#include "forward/base/random.h"
#include "forward/optics/direction.h"
#include "forward/optics/material.h"

namespace mezzotint::test {

/// Light through Smith's model of an isotropic Gaussian surface, all orders: a random walk in heights, as through a
/// volume of facets. Heights along a path know nothing of each other, nor of the slopes: what an explicit surface does
/// differently is what its correlations do.
///
/// How      A height is told by u, the share of the surface below it. On its way in direction ω a ray at u gets above
///          u' before it meets a facet with probability (u/u')^Λ(ω), Λ < 0 downwards; it leaves where that takes it
///          beyond u = 1. It meets a facet of slope with density ∝ max(0, −ω·m) D(m). Inside, all is turned upside
///          down.
/// Source   Heitz, Hanika, d'Eon, Dachsbacher, "Multiple-scattering microfacet BSDFs with the Smith model", SIGGRAPH
///          2016; Λ as in microfacet.h, written here once more.
class SmithWalk {
public:
  /// @param rms_gradient  s = Beckmann's α.
  SmithWalk(double rms_gradient, const Material& material, const Direction& to_light, std::uint64_t seed)
      : deviation_(rms_gradient / std::numbers::sqrt2), material_(material), way_in_(-to_light), seed_(seed) {}

  struct End {
    bool reflected = false;  ///< else transmitted
    int order = 0;           ///< number of facets met
    Direction way;
    double weight = 1.0;  ///< what a metal has not absorbed
  };
  /// One path; nothing where it meets more than `most` facets.
  [[nodiscard]] std::optional<End> path(std::uint64_t index, int most = 1000) const {
    Direction way = way_in_;
    double below = 1.0, weight = 1.0;
    bool inside = false;  // then `way` and `below` are upside down
    for (int order = 0; order <= most; ++order) {
      const std::array<double, 4> u = RandomStream(seed_, RandomPurpose::Test).uniform4(index, 2 * order);
      const std::array<double, 4> v = RandomStream(seed_, RandomPurpose::Test).uniform4(index, 2 * order + 1);
      below = below / std::pow(1.0 - u[0], 1.0 / signed_lambda(way));
      if (!(below < 1.0)) return End{!inside, order, turned(way, inside), weight};
      const Direction facet = visible_normal(-way, u[1], u[2], u[3]);
      const double cosine = std::min(1.0, -way.dot(facet));
      const auto* glass = std::get_if<Dielectric>(&material_);
      if (glass == nullptr) {
        weight *= reflectance(material_, cosine);
        way += 2.0 * cosine * facet;
        continue;
      }
      const double index_ratio = inside ? 1.0 / glass->eta : glass->eta;
      const DielectricFresnel fresnel = dielectric_fresnel(cosine, index_ratio);
      if (v[0] < fresnel.reflectance) {
        way += 2.0 * cosine * facet;
      } else {
        way = turned(way / index_ratio + (cosine / index_ratio - fresnel.cos_refracted) * facet, true);
        below = 1.0 - below;
        inside = !inside;
      }
    }
    return std::nullopt;
  }

private:
  static Direction turned(const Direction& way, bool over) { return {way.x(), way.y(), over ? -way.z() : way.z()}; }

  [[nodiscard]] double signed_lambda(const Direction& way) const {
    const double sine = std::max(1e-12, std::hypot(way.x(), way.y()));
    const double a = way.z() / (sine * deviation_ * std::numbers::sqrt2);
    return 0.5 * (std::exp(-a * a) / (a * std::sqrt(std::numbers::pi)) - std::erfc(a));
  }

  // Slope along the way with density ∝ (c − q·s)₊ · Gaussian(q), c and s cosine and sine of the direction that looks at
  // the facet: its distribution c·Φ + s·σ·φ is turned around by bisection. Across the way it is Gaussian.
  [[nodiscard]] Direction visible_normal(const Direction& viewer, double u, double v, double w) const {
    const double c = viewer.z(), s = std::max(1e-12, std::hypot(viewer.x(), viewer.y()));
    const auto below = [&](double t) {  // t = q/σ
      const double density = std::exp(-0.5 * t * t) / std::sqrt(2.0 * std::numbers::pi);
      return c * 0.5 * std::erfc(-t / std::numbers::sqrt2) + s * deviation_ * density;
    };
    double low = -9.0, high = std::min(9.0, c / (s * deviation_));
    const double wanted = u * below(high);
    for (int step = 0; step < 40; ++step) {
      const double middle = 0.5 * (low + high);
      (below(middle) < wanted ? low : high) = middle;
    }
    const double along = deviation_ * 0.5 * (low + high);
    const double across = deviation_ * std::sqrt(-2.0 * std::log(1.0 - v)) * std::cos(2.0 * std::numbers::pi * w);
    const bool upright = s < 1e-9;  // any direction is along the way then
    const double x = upright ? 1.0 : viewer.x() / s, y = upright ? 0.0 : viewer.y() / s;
    return Direction(-along * x + across * y, -along * y - across * x, 1.0).normalized();
  }

  double deviation_;
  Material material_;
  Direction way_in_;
  std::uint64_t seed_;
};

}  // namespace mezzotint::test
