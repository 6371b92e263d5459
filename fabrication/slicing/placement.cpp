#include "fabrication/slicing/placement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

struct Box {
  std::array<double, 3> low = {std::numeric_limits<double>::max(), std::numeric_limits<double>::max(),
                               std::numeric_limits<double>::max()};
  std::array<double, 3> high = {std::numeric_limits<double>::lowest(), std::numeric_limits<double>::lowest(),
                                std::numeric_limits<double>::lowest()};

  void include(const RasterPoint& p) {
    const std::array<double, 3> point = {p.x, p.y, p.z};
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], point[i]);
      high[i] = std::max(high[i], point[i]);
    }
  }
  [[nodiscard]] double size(std::size_t axis) const { return high[axis] - low[axis]; }
};

// Corners that no triangle uses do not count.
Box box_of(const PartMesh& part, const RasterFrame& frame) {
  Box box;
  for (const auto& triangle : part.triangles) {
    for (const std::uint32_t corner : triangle) {
      require(corner < part.vertices_mm.size(), "a triangle of the part names a corner that is not there");
      const RasterPoint point = frame(part.vertices_mm[corner]);
      require(std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z),
              "a corner of the part is no finite number");
      box.include(point);
    }
  }
  return box;
}

// A part may fill the field to its rim, as far as rounding allows.
constexpr double rounding_pixels = 1e-6;

struct Span {
  std::size_t begin, count;
};

Span pixels_of(double low, double high, std::size_t pixels) {
  const auto most = static_cast<double>(pixels);
  const double begin = std::clamp(std::floor(low), 0.0, most - 1.0);
  const double end = std::clamp(std::ceil(high), begin + 1.0, most);
  return {static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin)};
}

}  // namespace

PlacedPart place_part(const PartMesh& part, const PrinterProfile& profile, Length layer, const Placement& placement) {
  require(!part.triangles.empty(), "the part has no triangles");
  require_valid(profile);
  require(layer > Length{}, "a layer needs a thickness above 0");
  const double pitch_mm = profile.pixel_pitch.mm();
  PlacedPart placed;
  RasterFrame& frame = placed.frame;
  frame.xx = std::cos(placement.rotation.radians()) / pitch_mm;
  frame.xy = -std::sin(placement.rotation.radians()) / pitch_mm;
  frame.z = 1.0 / layer.mm();
  const Box box = box_of(part, frame);
  const auto columns = static_cast<double>(profile.pixels_x), rows = static_cast<double>(profile.pixels_y);
  frame.x0 = 0.5 * (columns - box.low[0] - box.high[0]) + placement.offset_x / profile.pixel_pitch;
  frame.y0 = 0.5 * (rows - box.low[1] - box.high[1]) + placement.offset_y / profile.pixel_pitch;
  frame.z0 = -box.low[2];
  const double left = box.low[0] + frame.x0, right = box.high[0] + frame.x0;
  const double front = box.low[1] + frame.y0, back = box.high[1] + frame.y0;
  const bool fits = left >= -rounding_pixels && right <= columns + rounding_pixels && front >= -rounding_pixels &&
                    back <= rows + rounding_pixels;
  require(
      fits,
      fmt::format("the part, {:.4g} x {:.4g} mm as it is turned, reaches from x = {:.4g} to {:.4g} and from y = {:.4g} "
                  "to {:.4g} mm; the printer's field is {:.4g} x {:.4g} mm ({} x {} pixels of {:.4g} um). Turn it, "
                  "move it or make it smaller",
                  box.size(0) * pitch_mm, box.size(1) * pitch_mm, left * pitch_mm, right * pitch_mm, front * pitch_mm,
                  back * pitch_mm, columns * pitch_mm, rows * pitch_mm, profile.pixels_x, profile.pixels_y,
                  profile.pixel_pitch.um()));
  const Span x = pixels_of(left, right, profile.pixels_x), y = pixels_of(front, back, profile.pixels_y);
  placed.window = {x.begin, y.begin, x.count, y.count};
  frame.x0 -= static_cast<double>(x.begin);
  frame.y0 -= static_cast<double>(y.begin);
  placed.height_layers = box.size(2);
  return placed;
}

}  // namespace mezzotint
