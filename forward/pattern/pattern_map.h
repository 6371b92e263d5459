#pragma once

#include <array>

#include "forward/base/units.h"
#include "forward/surface/height_field.h"

/// Inside of forward/pattern, and for forward/process.

namespace mezzotint {

/// An affine map from the plane of the surface, in µm, to the coordinates in which a pattern is defined.
struct PatternMap {
  double ux = 1.0, uy = 0.0;  ///< ∂u/∂x, ∂u/∂y
  double vx = 0.0, vy = 1.0;
  double u0 = 0.0, v0 = 0.0;  ///< (u, v) at x = y = 0

  [[nodiscard]] std::array<double, 2> operator()(double x_um, double y_um) const {
    return {ux * x_um + uy * y_um + u0, vx * x_um + vy * y_um + v0};
  }
  [[nodiscard]] double determinant() const { return ux * vy - uy * vx; }
};

/// The map whose u runs along `direction` of the old (u, v), and v across it.
[[nodiscard]] PatternMap turned(const PatternMap& map, Angle direction);
/// (u, v) in units of `unit_u` and `unit_v`.
[[nodiscard]] PatternMap in_units(const PatternMap& map, double unit_u, double unit_v);

/// The map with so much added to u and v.
[[nodiscard]] PatternMap moved(PatternMap map, double u, double v);
/// The map with u and v multiplied by these.
[[nodiscard]] PatternMap scaled(const PatternMap& map, double u, double v);
[[nodiscard]] PatternMap sum(const PatternMap& a, const PatternMap& b);

/// What maps every point to (0, 0): a change that is none.
inline constexpr PatternMap no_map{0.0, 0.0, 0.0, 0.0, 0.0, 0.0};

/// Where a pattern is drawn.
struct Sheet {
  Grid grid;
  PatternMap place;  ///< from the grid to the pattern's plane, both in µm
  Continuation continuation = Continuation::Mirrored;

  [[nodiscard]] double width_um() const { return static_cast<double>(grid.columns) * grid.pitch_x.um(); }
  [[nodiscard]] double depth_um() const { return static_cast<double>(grid.rows) * grid.pitch_y.um(); }
};

/// On a periodic sheet the nearest map under which the tile holds whole numbers of periods of u and of v along each
/// of its sides; on another sheet the map itself.
/// @throws InvalidInput for a tile so small that no period is left.
[[nodiscard]] PatternMap fitted(PatternMap map, const Sheet& sheet);
/// The same for a pattern that only has a u.
[[nodiscard]] PatternMap fitted_along_u(PatternMap map, const Sheet& sheet);

}  // namespace mezzotint
