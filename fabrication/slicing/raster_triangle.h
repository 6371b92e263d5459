#pragma once

#include <array>

namespace mezzotint {

/// A corner of a triangle as the layers see it.
///
/// Frame    x along a projector row, y along a column, z up; pixel (c, r) is the square [c, c + 1] × [r, r + 1] and
///          layer k the slab [k, k + 1].
/// Units    x and y in pixels, z in layers.
struct RasterPoint {
  double x = 0.0, y = 0.0, z = 0.0;
};

/// Counter-clockwise seen from outside of the material.
using RasterTriangle = std::array<RasterPoint, 3>;

}  // namespace mezzotint
