#include "fabrication/slicing/slab_raster.h"

#include <fmt/format.h>

#include <algorithm>

#include "fabrication/slicing/slab_cut.h"
#include "forward/base/error.h"

namespace mezzotint {

namespace {

constexpr std::size_t largest_side = 65535;

std::size_t checked_side(std::size_t pixels) {
  require(pixels > 0 && pixels <= largest_side,
          fmt::format("a layer of {} pixels a side; 1 to {} are right", pixels, largest_side));
  return pixels;
}

RasterTriangle seen_from_layer(const RasterTriangle& triangle, double layer) {
  RasterTriangle seen = triangle;
  for (RasterPoint& point : seen) point.z -= layer;
  return seen;
}

}  // namespace

SlabRaster::SlabRaster(std::size_t columns, std::size_t rows, const CoverageOptions& options)
    : rows_(checked_side(columns), checked_side(rows)), options_(options) {
  require(
      options.supersample >= 0 && options.supersample <= most_supersamples,
      fmt::format("{} samples a side of a pixel; 0 (exact) to {} are right", options.supersample, most_supersamples));
}

void SlabRaster::add(std::span<const RasterTriangle> triangles) {
  const bool by_volume = options_.supersample == 0 && options_.mode == CoverageMode::Volume;
  for (const RasterTriangle& triangle : triangles) {
    const auto [low, high] = std::minmax({triangle[0].z, triangle[1].z, triangle[2].z});
    if (high <= layer_ || low >= layer_ + 1.0) continue;
    const RasterTriangle seen = seen_from_layer(triangle, layer_);
    if (by_volume) {
      add_volume(rows_, seen);
    } else if (options_.supersample > 0) {
      add_plane_samples(rows_, seen, options_.supersample);
    } else {
      add_plane_cut(rows_, seen);
    }
  }
}

}  // namespace mezzotint
