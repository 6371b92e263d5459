#pragma once

#include <cmath>
#include <string>

#include "forward/optics/microfacet.h"
#include "forward/surface/height_field.h"
#include "forward/surface/slope_covariance.h"

namespace mezzotint {

/// What a printed surface should show, as slopes: by the microfacet relation an anisotropic Beckmann lobe with
/// α_x, α_y *is* a slope distribution with RMS slopes α_x/√2, α_y/√2.
struct Target {
  std::string kind;              ///< "beckmann", "anisotropy", "scan": what the user named
  SlopeAxes slopes;              ///< wanted RMS slopes along their own axes
  bool rotation_matters = true;  ///< false for a round lobe, or where the user left the direction open
  /// Largest relative error of either variance of the slope covariance; of a lobe: largest cube-root error.
  /// Infinite: none was stated, nothing is judged.
  double tolerance = 0.05;
  Angle rotation_tolerance = Angle::from_degrees(2.0);
};

/// @throws InvalidInput for α_x < α_y (α_x is the steeper axis by definition) or α outside of 1e-3 … 2.
[[nodiscard]] Target beckmann_target(const BeckmannLobe& lobe);

/// An anisotropy ratio α_x/α_y ≥ 1 and a mean roughness √(α_x·α_y); the direction is open.
[[nodiscard]] Target anisotropy_target(double ratio, double mean_alpha);

/// The slopes of a measured relief (levelled, without missing samples).
[[nodiscard]] Target scan_target(const HeightField& relief);

/// The Beckmann lobe of given slopes.
[[nodiscard]] BeckmannLobe lobe_of(const SlopeAxes& slopes);

[[nodiscard]] inline bool is_judged(const Target& target) { return std::isfinite(target.tolerance); }

/// How far a slope covariance is from a target.
struct TargetError {
  double variance_major = 0.0;  ///< relative error of the variance along the steeper axis
  double variance_minor = 0.0;
  Angle rotation;  ///< unsigned; 0 where it does not matter
  [[nodiscard]] double largest() const;
};
[[nodiscard]] TargetError target_error(const SlopeCovariance& achieved, const Target& target);
[[nodiscard]] bool is_met(const TargetError& error, const Target& target);

/// The figure that a search lowers: squared distance of two covariances in logarithms, which counts both axes
/// alike and is the same in every frame: ‖log(T^−½ C T^−½)‖²; (Δlog ratio)² + (Δlog mean)² where the
/// rotation does not matter. Zero on target; large, but finite, for a flat surface.
/// Source   Förstner & Moonen 1999, "A metric for covariance matrices".
[[nodiscard]] double covariance_distance(const SlopeCovariance& achieved, const Target& target);

/// The same, with its slopes toward the three numbers of the covariance. Where the rotation does not matter and both
/// variances are equal, the distance has a kink, and the slopes are those of one of its sides.
struct CovarianceDistance {
  double value = 0.0;
  SlopeCovariance slopes;  ///< ∂value/∂xx, ∂value/∂yy, ∂value/∂xy
};
[[nodiscard]] CovarianceDistance covariance_distance_with_slopes(const SlopeCovariance& achieved, const Target& target);

}  // namespace mezzotint
