#pragma once

#include "forward/base/units.h"
#include "forward/surface/height_field.h"

namespace mezzotint {

/// Second moments of the slopes (∂z/∂x, ∂z/∂y) of a relief about their mean (a tilt is no roughness).
///
/// Units    dimensionless (rise over run). The variances are the squares of the RMS slopes σ.
struct SlopeCovariance {
  double xx = 0.0;
  double yy = 0.0;
  double xy = 0.0;
};

/// The same moments along their own axes.
///
/// Frame    `rotation` runs from +x, counter-clockwise, to the axis of the steeper slopes, in (−90°, 90°].
///          Where both are equal it means nothing and is 0.
struct SlopeAxes {
  double rms_major = 0.0;  ///< σ along the steeper axis; the Beckmann α there is √2·σ
  double rms_minor = 0.0;
  Angle rotation;
};

[[nodiscard]] SlopeAxes principal_axes(const SlopeCovariance& covariance);
[[nodiscard]] SlopeCovariance covariance_of(const SlopeAxes& axes);

/// Slope covariance over the facets of the field's mesh (two triangles a cell, as `to_mesh` makes
/// them): the slopes that a ray meets. Cells with a missing corner are left out; a periodic field
/// counts the cells that close it.
/// @throws InvalidInput when no whole cell is left.
[[nodiscard]] SlopeCovariance slope_covariance(const HeightField& field);

/// The unsigned angle between two axes (period 180°), in [0°, 90°].
[[nodiscard]] Angle axis_difference(Angle a, Angle b);

}  // namespace mezzotint
