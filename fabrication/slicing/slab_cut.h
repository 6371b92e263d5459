#pragma once

#include "fabrication/slicing/area_rows.h"
#include "fabrication/slicing/raster_triangle.h"

namespace mezzotint {

// Where a triangle crosses a layer, summed into the rows. z counts from the layer's lower face: [0, 1] is the layer.

/// The volume between the triangle and the right end of the rows, within the layer.
void add_volume(AreaRows& rows, const RasterTriangle& triangle);

/// The area right of the line in which the triangle cuts the plane z = 1/2.
void add_plane_cut(AreaRows& rows, const RasterTriangle& triangle);

/// The same, as counted by `samples` × `samples` points a pixel, each in the middle of its share.
void add_plane_samples(AreaRows& rows, const RasterTriangle& triangle, int samples);

}  // namespace mezzotint
