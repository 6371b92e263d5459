#pragma once

#include <cstddef>

#include "fabrication/part/part_mesh.h"
#include "fabrication/slicing/raster_triangle.h"
#include "forward/process/printer_profile.h"

namespace mezzotint {

/// How a part stands on the platform: turned about z, then the middle of its bounding box in the middle of the
/// projector's field, moved by an offset; its lowest point on the platform.
struct Placement {
  Angle rotation;  ///< counter-clockwise seen from above
  Length offset_x, offset_y;
};

/// Part of the projector's field, in pixels.
struct PixelWindow {
  std::size_t column = 0, row = 0, columns = 0, rows = 0;
};

/// Where a point of the part lies in the window, and in which layer.
struct RasterFrame {
  double xx = 1.0, xy = 0.0;  ///< pixels a mm: x = xx·X + xy·Y + x0, y = xx·Y − xy·X + y0
  double z = 1.0;             ///< layers a mm: z·Z + z0
  double x0 = 0.0, y0 = 0.0, z0 = 0.0;

  [[nodiscard]] RasterPoint operator()(const std::array<double, 3>& point_mm) const {
    const auto& [X, Y, Z] = point_mm;
    return {xx * X + xy * Y + x0, xx * Y - xy * X + y0, z * Z + z0};
  }
};

struct PlacedPart {
  RasterFrame frame;
  PixelWindow window;  ///< the pixels that the part may touch
  double height_layers = 0.0;
};

/// @throws InvalidInput for a part without triangles or with coordinates that are no numbers, or one that is larger
///         than the printer's field as it is placed; the message says by how much.
[[nodiscard]] PlacedPart place_part(const PartMesh& part, const PrinterProfile& profile, Length layer,
                                    const Placement& placement);

}  // namespace mezzotint
