#pragma once

#include <cmath>
#include <cstddef>

#include "forward/base/units.h"
#include "forward/surface/height_field.h"

namespace mezzotint {

/// Calls `use(∂z/∂x, ∂z/∂y)` for every facet of the field's mesh (two triangles a cell, split as `to_mesh` splits
/// them). Cells with a missing corner are left out; a periodic field counts the cells that close it.
template <typename Use>
void for_each_facet_slope(const HeightField& field, const Use& use);

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

template <typename Use>
void for_each_facet_slope(const HeightField& field, const Use& use) {
  const double per_x = 1.0 / field.grid().pitch_x.um(), per_y = 1.0 / field.grid().pitch_y.um();
  const std::size_t closing = field.periodic() ? 0 : 1;
  for (std::size_t row = 0; row + closing < field.rows(); ++row) {
    const std::size_t next_row = row + 1 == field.rows() ? 0 : row + 1;
    for (std::size_t column = 0; column + closing < field.columns(); ++column) {
      const std::size_t next = column + 1 == field.columns() ? 0 : column + 1;
      const double z00 = field.at(column, row), z10 = field.at(next, row);
      const double z01 = field.at(column, next_row), z11 = field.at(next, next_row);
      if (std::isnan(z00 + z10 + z01 + z11)) continue;
      use((z10 - z00) * per_x, (z11 - z10) * per_y);
      use((z11 - z01) * per_x, (z01 - z00) * per_y);
    }
  }
}

/// The unsigned angle between two axes (period 180°), in [0°, 90°].
[[nodiscard]] Angle axis_difference(Angle a, Angle b);

}  // namespace mezzotint
