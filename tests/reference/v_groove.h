#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "forward/optics/direction.h"
#include "forward/optics/material.h"

namespace mezzotint::test {

/// Light of one order of interaction that leaves a groove in one direction, as a share of all that came in.
struct GrooveBeam {
  int order = 0;
  Direction way;  ///< unit vector, as the light travels: up for reflection, down for transmission
  double share = 0.0;
};
struct GrooveLight {
  std::vector<GrooveBeam> reflected, transmitted;
  /// Whether all refracted light falls more steeply than the facets, and so never meets one again from below. Without
  /// it `transmitted` and the reflection from the third order on are not all there is.
  bool refracts_for_good = true;
};

/// What periodic symmetric V-grooves along y send where, in closed form: images in place of bounces.
///
/// How      In the xz-plane the groove is a wedge of opening π − 2ρ, ρ = atan(slope), with sides of length 1. Unfolded
///          about its apex at each bounce it becomes a fan of images, which light crosses on a straight line. A line at
///          distance c from the apex crosses the radius at angle φ from the light's direction where c < sin φ, and it
///          leaves through the first image's mouth whose far radius it does not cross. Light is uniform in c. Facets
///          leave the component along y alone, and every cosine is sin φ times the length of the rest.
/// Source   V-cavities: Torrance & Sparrow 1967; Blinn 1977; all orders by images: Lee et al., "Practical multiple
///          scattering for rough surfaces", 2018.
class VGroove {
public:
  VGroove(double slope, const Direction& to_light, const Material& material)
      : slope_(slope), to_light_(to_light), material_(material), in_plane_(std::hypot(to_light.x(), to_light.z())) {}

  [[nodiscard]] GrooveLight light() const {
    const double lift = std::atan(slope_), toward_light = std::atan2(to_light_.z(), to_light_.x());
    const double to_right = toward_light - lift, to_left = std::numbers::pi - lift - toward_light;
    GrooveLight result;
    add_side(+1.0, to_right, to_left, result);
    add_side(-1.0, to_left, to_right, result);
    return result;
  }

private:
  // Lines that pass the apex on the side of one facet: it lies at `near` from the light's direction, the other at
  // `far`.
  void add_side(double side, double near, double far, GrooveLight& result) const {
    const double opening = near + far, mouth = std::sin(near) + std::sin(far);
    const double closest = std::max(0.0, -std::sin(far));  // the other tip may shade the apex
    const auto reach = [&](int k) {
      const double angle = near + (k - 1) * opening;
      return angle < std::numbers::pi ? std::max(0.0, std::sin(angle)) : 0.0;
    };
    Direction way = -to_light_;
    double crossing = reach(1), weight = 1.0;
    for (int order = 1; crossing > closest; ++order) {
      const double cosine = in_plane_ * std::sin(near + (order - 1) * opening);
      const Direction normal = Direction(order % 2 == 1 ? -side * slope_ : side * slope_, 0.0, 1.0).normalized();
      refract(way, normal, cosine, weight * (crossing - closest) / mouth, order, result);
      way += 2.0 * cosine * normal;
      weight *= reflectance(material_, cosine);
      const double leaving = crossing - std::max(closest, reach(order + 1));
      if (leaving > 0.0) result.reflected.push_back({order, way, weight * leaving / mouth});
      crossing = std::min(crossing, reach(order + 1));
    }
  }

  void refract(const Direction& way, const Direction& normal, double cosine, double arriving, int order,
               GrooveLight& result) const {
    const auto* glass = std::get_if<Dielectric>(&material_);
    if (glass == nullptr) return;
    const double sine = std::sqrt(1.0 - cosine * cosine) / glass->eta;
    const Direction down = way / glass->eta + (cosine / glass->eta - std::sqrt(1.0 - sine * sine)) * normal;
    if (!(-down.z() > slope_ * std::abs(down.x()))) result.refracts_for_good = false;
    result.transmitted.push_back({order, down, arriving * (1.0 - reflectance(material_, cosine))});
  }

  double slope_;
  Direction to_light_;
  Material material_;
  double in_plane_;
};

}  // namespace mezzotint::test
