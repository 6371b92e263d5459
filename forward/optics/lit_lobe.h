#pragma once

#include "forward/optics/microfacet.h"

/// Inside of forward/optics: a lobe with what does not change from one direction to the next worked out.

namespace mezzotint {

class LobeFrame {
public:
  explicit LobeFrame(const BeckmannLobe& lobe);

  /// Slope of a facet with this normal (of any length, z > 0) along the lobe's own axes, in units of α:
  /// the distribution of slopes is exp(−|·|²)/π there.
  [[nodiscard]] Eigen::Vector2d scaled_slope(const Direction& normal) const {
    const double along = cosine_ * normal.x() + sine_ * normal.y();
    const double across = cosine_ * normal.y() - sine_ * normal.x();
    return {along / (alpha_x_ * normal.z()), across / (alpha_y_ * normal.z())};
  }
  [[nodiscard]] double distribution(const Direction& normal) const;
  [[nodiscard]] double smith_lambda(const Direction& direction) const;

private:
  double alpha_x_, alpha_y_, cosine_, sine_;
};

class LitLobe {
public:
  LitLobe(const BeckmannLobe& lobe, const Material& material, const Direction& to_light);

  [[nodiscard]] double brdf(const Direction& to_viewer) const;
  /// Scaled slope of the facets that send the light to the viewer.
  [[nodiscard]] Eigen::Vector2d scaled_slope_toward(const Direction& to_viewer) const {
    return frame_.scaled_slope(to_light_ + to_viewer);
  }

private:
  LobeFrame frame_;
  Material material_;
  Direction to_light_;
  double lambda_light_;
};

}  // namespace mezzotint
