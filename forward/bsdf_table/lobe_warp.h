#pragma once

#include "forward/optics/direction.h"

namespace mezzotint {

/// The unit disc of outgoing directions, laid out around the lobe of one direction of the light, in slopes.
///
/// Frame    the orthographic projection of DirectionGrid. The facet of slope m sends light from ω_i to
///          ω_o = −ω_i − 2m (c − m·ω_i) / (1 + m²), c = cosθ_i: on a straight line through the mirror direction
///          −ω_i, in the direction of −m. Every slope up to `reach`, which sends light to the horizon, is seen.
/// Source   the half vector of Walter et al. 2007. For transmission, lines through Snell's direction −ω_i/η, and the
///          slope to first order: the distance divided by (η cosθ_t − cosθ_i)/η.
class LobeChart {
public:
  /// @param to_light  above the horizon.
  [[nodiscard]] static LobeChart of_reflection(const Direction& to_light);
  /// @param relative_index  n(beyond) / n(here), at least 1.0001.
  [[nodiscard]] static LobeChart of_transmission(const Direction& to_light, double relative_index);

  [[nodiscard]] const Eigen::Vector2d& centre() const { return centre_; }
  [[nodiscard]] double slope_at(const Eigen::Vector2d& point) const;
  /// The steepest slope along a line from the centre; `toward` is a unit vector.
  [[nodiscard]] double reach(const Eigen::Vector2d& toward) const;
  /// Distance of a slope's direction from the centre.
  [[nodiscard]] double distance(double slope, const Eigen::Vector2d& toward) const;
  /// Area of the disc an area of slopes, without the factor `gap` = reach − slope that takes it to 0 at the rim.
  [[nodiscard]] double density_without_gap(double slope, double reach, const Eigen::Vector2d& toward) const;
  [[nodiscard]] bool ends_flat() const { return ends_flat_; }

private:
  Eigen::Vector2d centre_ = Eigen::Vector2d::Zero();
  double cosine_ = 1.0;
  double scale_ = 1.0;     // transmission: distance an unit of slope
  bool ends_flat_ = true;  // reflection: the density falls to 0 at the rim
};

/// Moves a lobe with the light: a one-to-one map of the disc around one chart onto that of another.
///
/// How      Along each line the slope stays what it is, μ' ≈ μ, as far from both horizons as the lobe reaches, and is
///          squeezed so that horizon meets horizon: μ'⁻² − M'⁻² = μ⁻² − M⁻², M the reach. So nothing is lost or made,
///          and a lobe of slopes far below M is moved exactly.
class LobeWarp {
public:
  LobeWarp(const LobeChart& from, const LobeChart& to) : from_(from), to_(to) {}

  struct Image {
    Eigen::Vector2d point;
    double jacobian;  ///< area of the image an area of the source
  };
  [[nodiscard]] Image operator()(const Eigen::Vector2d& point) const;

private:
  LobeChart from_, to_;
};

}  // namespace mezzotint
