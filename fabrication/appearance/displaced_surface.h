#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "fabrication/appearance/relief_probe.h"
#include "fabrication/appearance/smooth_surface.h"
#include "fabrication/slicing/placement.h"
#include "fabrication/slicing/raster_triangle.h"

namespace mezzotint {

/// Micro-triangles of some layers: all that touch `layer`, piece by piece.
using TakeMicroTriangles = std::function<void(std::size_t layer, std::span<const RasterTriangle> triangles)>;

/// A part whose surface is moved outward by a relief, as triangles about half a pixel wide that are made when their
/// layers are sliced and never kept: memory does not grow with their number.
///
/// Closed   where the part is: an edge is halved until it is short enough, by its own length alone, and points of an
///          edge or vertex ask the relief on one side only, so that neighbours agree to the last bit.
/// Creases  their points move by the mitre of both sides' displacements, all others along the normal of their smooth
///          piece; so flat faces stay exactly under their relief up to the last half pixel.
/// Platform points of the plane in which the part stands are not moved; what is pushed below is cut off by slicing.
/// Costs    some 0.2 µs a micro-triangle besides the relief's own time, and a band's margins are made twice.
class DisplacedSurface {
public:
  /// @param longest_edge  of a micro-triangle before it is displaced; ¾ of a pixel makes half a pixel on average
  DisplacedSurface(SmoothSurface surface, SurfaceRelief relief, const RasterFrame& frame, Length longest_edge);
  ~DisplacedSurface();
  DisplacedSurface(DisplacedSurface&&) noexcept;
  DisplacedSurface& operator=(DisplacedSurface&&) noexcept;

  /// Every layer of a band with what touches it, in a fixed order. Safe to use from several threads.
  void for_each_triangle(std::size_t first_layer, std::size_t layers, const TakeMicroTriangles& take) const;

  /// All micro-triangles, in no layer's order; for measuring the whole.
  void for_all_triangles(const std::function<void(const RasterTriangle&)>& take) const;

  /// Where its highest points can be, in layers.
  [[nodiscard]] double highest_layer() const;

private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

}  // namespace mezzotint
