#pragma once

#include "forward/optics/microfacet.h"

/// Inside of forward/optics: a lobe with what does not change from one direction to the next worked out.

namespace mezzotint {

class LobeFrame {
public:
  explicit LobeFrame(const MicrofacetLobe& lobe);

  /// Slope of a facet with this normal (of any length, z > 0) along the lobe's own axes, in units of α: there the
  /// distribution of slopes depends on the length alone.
  [[nodiscard]] Eigen::Vector2d scaled_slope(const Direction& normal) const {
    const double along = cosine_ * normal.x() + sine_ * normal.y();
    const double across = cosine_ * normal.y() - sine_ * normal.x();
    return {along / (alpha_x_ * normal.z()), across / (alpha_y_ * normal.z())};
  }
  [[nodiscard]] double distribution(const Direction& normal) const;
  [[nodiscard]] double smith_lambda(const Direction& direction) const;
  /// How far scaled slopes may reach in a part whose nearest one is this long, so that a four-point rule a side takes
  /// the mean of the distribution there to about 1e-6 of the peak.
  [[nodiscard]] double smooth_over(double slope) const;

private:
  enum class Shape { Beckmann, Ggx };
  Shape shape_;
  double alpha_x_ = 0.0, alpha_y_ = 0.0, cosine_ = 1.0, sine_ = 0.0;
};

class LitLobe {
public:
  LitLobe(const MicrofacetLobe& lobe, const Material& material, const Direction& to_light);

  [[nodiscard]] double brdf(const Direction& to_viewer) const;
  [[nodiscard]] double smooth_over(double slope) const { return frame_.smooth_over(slope); }
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
