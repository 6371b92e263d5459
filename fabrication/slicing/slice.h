#pragma once

#include <functional>
#include <optional>
#include <string>

#include "fabrication/job/layer_picture.h"
#include "fabrication/part/part_mesh.h"
#include "fabrication/slicing/coverage.h"
#include "fabrication/slicing/placement.h"
#include "fabrication/slicing/proximity_layer.h"
#include "fabrication/slicing/slab_source.h"
#include "forward/base/progress.h"

namespace mezzotint {

/// How a part becomes layers. The defaults are what a printer of gray layers expects: exact volumes, through the cure
/// curve.
struct SliceOptions {
  CoverageOptions coverage;
  std::optional<Length> layer;  ///< the profile's own where it is left out
  Placement placement;
  /// Gray is the coverage, as other slicers have it, rather than what cures to it.
  bool linear = false;
  /// Gray whose print, with the projector's blur, gives each pixel its share of the layer: what neighbours give and
  /// take is reckoned with. Costs some seconds for a million pixels of edges. Not with `linear`.
  bool proximity_correction = false;
};

/// What came of a layer, or of all layers together.
struct SliceFigures {
  double coverage_pixels = 0.0;  ///< sum of the exact coverage
  std::uint64_t lit_pixels = 0;  ///< pixels with light
  std::uint64_t gray_sum = 0;    ///< of the 8-bit levels
  std::uint64_t saturated = 0;   ///< pixels that want more than full gray cures
  std::uint64_t open_rows = 0;   ///< rows in which the surface does not close: it has holes there
  ProximityFigures proximity;    ///< where it was asked for
  SliceFigures& operator+=(const SliceFigures& other);
};

/// One layer, whole: its picture has the size of the printer's field.
struct SlicedLayer {
  std::size_t index = 0;
  Length top;  ///< height of its upper face over the platform
  LayerPicture picture;
  SliceFigures figures;
  std::string packed;  ///< what PackLayer made of the picture
};

/// Work on a finished picture that can be done for several layers at once (to compress it).
using PackLayer = std::function<std::string(const LayerPicture&)>;
/// Takes the layers in order, from the platform up, on the thread that slices.
using TakeLayer = std::function<void(SlicedLayer&&)>;

struct SliceSummary {
  SliceFigures total;
  std::size_t layers = 0;
  double volume_mm3 = 0.0;  ///< coverage × pixel area × layer
  double height_mm = 0.0;   ///< of all layers
  /// What full gray cures of a layer, as a share; below 1 every full pixel is short by the rest.
  double largest_coverage = 1.0;
};

/// A part as layers of gray.
///
/// Costs    memory for a few layers, whatever their number, and 8 bytes a triangle.
/// Threads  several layers at a time; the same bits with any number of threads.
/// Height   a last layer that the part fills by less than a thousandth is left out.
/// Errors   InvalidInput where the part does not fit the field (by `place_part`), or is flat.
[[nodiscard]] SliceSummary slice_part(const PartMesh& part, const PrinterProfile& profile, const SliceOptions& options,
                                      const PackLayer& pack, const TakeLayer& take, const Progress& progress = {});

/// The same for triangles from any source; the window says where in the field they lie.
[[nodiscard]] SliceSummary slice_source(const SlabSource& source, std::size_t layer_count, const PixelWindow& window,
                                        const PrinterProfile& profile, const SliceOptions& options,
                                        const PackLayer& pack, const TakeLayer& take, const Progress& progress = {});

/// Layers that a part of this height has.
[[nodiscard]] std::size_t layer_count(double height_layers, const CoverageOptions& options);

}  // namespace mezzotint
