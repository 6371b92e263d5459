#pragma once

#include "forward/surface/height_field.h"

namespace mezzotint {

/// A place in the frame of a height field.
struct FieldPoint {
  double x_um = 0.0;
  double y_um = 0.0;
};

/// The middle of a grid's samples: half way from the first to the last.
[[nodiscard]] FieldPoint middle_of(const Grid& grid);

/// Height between the samples, by cubic convolution (a = −½: exact for parabolas, continuous slopes).
///
/// Units    micrometres.
/// Missing  NaN outside of the samples of a patch (a periodic field has no outside), and where one of the (up to)
///          four samples around the point is missing. One of the outer twelve that is missing or lies outside is
///          extrapolated along its line (Keys's end condition), so a hole grows by no more than the cells that touch
///          it.
/// Aliasing it interpolates, it does not average: for a coarser grid use `area_average` first.
/// Source   Keys, "Cubic convolution interpolation for digital image processing", IEEE TASSP 29 (1981).
[[nodiscard]] double height_um_at(const HeightField& field, FieldPoint point);

/// The same height with its slopes ∂z/∂x, ∂z/∂y (of the interpolant, exactly).
struct SurfacePoint {
  double height_um = 0.0;
  double slope_x = 0.0;
  double slope_y = 0.0;
};
[[nodiscard]] SurfacePoint surface_at(const HeightField& field, FieldPoint point);

/// Each height replaced by the mean over a rectangle around it: what a pixel of that size sees. A sample stands for
/// its own cell, so widths up to the pitch change nothing along that axis.
/// Missing  left out of the mean; where less than `least_share` of the rectangle was measured, the mean is missing.
///          With 1 only whole rectangles count, so the rim of a patch is lost; with less, the means at the rim are
///          one-sided.
/// @throws InvalidInput for a width that is negative or wider than the field, or a share not in (0, 1].
[[nodiscard]] HeightField area_average(const HeightField& field, Length width_x, Length width_y,
                                       double least_share = 0.5);

}  // namespace mezzotint
