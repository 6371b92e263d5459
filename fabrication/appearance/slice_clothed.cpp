#include "fabrication/appearance/slice_clothed.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

// Of a pixel: half of one on average, since longer sides are halved.
constexpr double longest_edge_pixels = 0.75;
// By how many displacements a mitre may reach over (SmoothSurface).
constexpr double longest_mitre = 3.0;

struct Interval {
  std::size_t begin, count;
};

// Pixels on either side, as far as the field goes.
Interval widened(std::size_t begin, std::size_t count, std::size_t by, std::size_t field) {
  const std::size_t first = begin - std::min(begin, by);
  return {first, std::min(begin + count + by, field) - first};
}

PixelWindow window_with_relief(const PixelWindow& window, const PrinterProfile& profile, Length highest) {
  const double pixels = std::max(0.0, highest / profile.pixel_pitch);
  const auto least = static_cast<std::size_t>(std::ceil(pixels - 1e-6));
  const bool fits = window.column >= least && window.row >= least &&
                    window.column + window.columns + least <= profile.pixels_x &&
                    window.row + window.rows + least <= profile.pixels_y;
  require(fits,
          fmt::format("the part fits into the printer's field, but not with a relief of {:.4g} um around it; make "
                      "it smaller or move it by {} pixels",
                      highest.um(), least));
  const auto most = static_cast<std::size_t>(std::ceil(longest_mitre * pixels)) + 1;
  const Interval x = widened(window.column, window.columns, most, profile.pixels_x);
  const Interval y = widened(window.row, window.rows, most, profile.pixels_y);
  return {x.begin, y.begin, x.count, y.count};
}

}  // namespace

SlabSource displaced_source(const DisplacedSurface& surface) {
  return [&surface](std::size_t layer) -> FeedLayer {
    return [&surface, layer](const AddTriangles& add) {
      surface.for_each_triangle(layer, 1, [&add](std::size_t, std::span<const RasterTriangle> some) { add(some); });
    };
  };
}

SliceSummary slice_clothed(const PartMesh& part, SmoothSurface surface, SurfaceRelief relief,
                           const PrinterProfile& profile, const SliceOptions& options, const PackLayer& pack,
                           const TakeLayer& take, const Progress& progress) {
  PlacedPart placed = place_part(part, profile, options.layer.value_or(profile.layer), options.placement);
  // The window begins at a pixel of the field: the frame's origin moves with it.
  const PixelWindow window = window_with_relief(placed.window, profile, relief.highest);
  placed.frame.x0 += static_cast<double>(placed.window.column) - static_cast<double>(window.column);
  placed.frame.y0 += static_cast<double>(placed.window.row) - static_cast<double>(window.row);
  const DisplacedSurface displaced(std::move(surface), std::move(relief), placed.frame,
                                   profile.pixel_pitch * longest_edge_pixels);
  const std::size_t layers = layer_count(displaced.highest_layer(), options.coverage);
  return slice_source(displaced_source(displaced), layers, window, profile, options, pack, take, progress);
}

}  // namespace mezzotint
