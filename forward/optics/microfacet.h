#pragma once

#include <variant>

#include "forward/optics/direction.h"
#include "forward/optics/direction_map.h"
#include "forward/optics/material.h"

namespace mezzotint {

/// An anisotropic Beckmann lobe: Gaussian slopes with RMS α_x/√2 and α_y/√2 along its own axes.
///
/// Frame    `rotation` runs from +x, counter-clockwise, to the axis of α_x.
/// Units    dimensionless; valid 1e-4 … 4.
/// Source   Walter et al. 2007; Heitz 2014 (height-correlated Smith G₂ = 1/(1 + Λ_i + Λ_o), with
///          Λ at a = cotθ/α(φ), α²(φ) = α_x² cos²(φ−ψ) + α_y² sin²(φ−ψ); Λ exact by erf).
struct BeckmannLobe {
  double alpha_x = 0.3;
  double alpha_y = 0.3;
  Angle rotation;
};

/// An anisotropic GGX (Trowbridge–Reitz) lobe: slopes with density 1/(π(1 + r²)²), r in units of α along its own
/// axes. Its tails are long: the slopes have no RMS, so no α of a relief is that of a GGX lobe.
///
/// Frame, Units  as BeckmannLobe.
/// Source        Walter et al. 2007; Heitz 2014; Λ = (√(1 + 1/a²) − 1)/2.
struct GgxLobe {
  double alpha_x = 0.3;
  double alpha_y = 0.3;
  Angle rotation;
};

/// A microfacet lobe: what the functions below hold for.
using MicrofacetLobe = std::variant<BeckmannLobe, GgxLobe>;

/// @throws InvalidInput for an α outside of 1e-4 … 4 or not finite.
void require_valid(const MicrofacetLobe& lobe);

/// The functions of single directions do not check the lobe: they stand in inner loops.

/// Distribution of normals D(m); ∫ D (m·n) dω = 1.
[[nodiscard]] double distribution(const MicrofacetLobe& lobe, const Direction& normal);
/// Smith's Λ of a direction; the same for its mirror image below.
[[nodiscard]] double smith_lambda(const MicrofacetLobe& lobe, const Direction& direction);
/// Single-scatter reflectance F D G₂ / (4 cosθ_i cosθ_o), per steradian; 0 below the horizon.
[[nodiscard]] double brdf(const MicrofacetLobe& lobe, const Material& material, const Direction& to_light,
                          const Direction& to_viewer);
/// The lobe as a direction map for one direction of the light: averaged over pixel ∩ disc, by
/// subdivision down to the width of the lobe, so that Σ map · area is its albedo within 1e-4 for every α.
/// Takes milliseconds at 64², up to seconds for a lobe that is long and thinner than a hundredth of a bin.
/// @throws InvalidInput for a bad lobe or grid, or a light that is not above the horizon.
[[nodiscard]] DirectionMap reflection_map(const MicrofacetLobe& lobe, const Material& material,
                                          const DirectionAngles& to_light, const DirectionGrid& grid);

}  // namespace mezzotint
