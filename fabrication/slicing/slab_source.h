#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "fabrication/slicing/placement.h"
#include "fabrication/slicing/raster_triangle.h"

namespace mezzotint {

/// Takes triangles in bulk; a few hundred at a time keep them in the cache.
using AddTriangles = std::function<void(std::span<const RasterTriangle>)>;

/// Gives all triangles that may touch a layer, in an order of its own that is always the same. Called once, on any
/// thread, at the same time as those of other layers.
using FeedLayer = std::function<void(const AddTriangles& add)>;

/// Where a layer's triangles come from: a mesh, or a pattern that is displaced while it is sliced. Called for each
/// layer in turn, from the platform up, on the thread that slices.
using SlabSource = std::function<FeedLayer(std::size_t layer)>;

/// The triangles of a mesh, each in the layers between its lowest and its highest corner; those that face along the
/// rows are left out, since they add nothing. The mesh must outlive the source.
///
/// Costs    8 bytes a triangle, and an index for each of a layer's triangles.
[[nodiscard]] SlabSource mesh_source(const PartMesh& part, const RasterFrame& frame, std::size_t layer_count);

}  // namespace mezzotint
