#pragma once

#include "fabrication/appearance/displaced_surface.h"
#include "fabrication/slicing/slice.h"

namespace mezzotint {

/// The micro-triangles of a displaced surface, layer by layer, for `slice_source`. The surface must outlive it.
[[nodiscard]] SlabSource displaced_source(const DisplacedSurface& surface);

/// A part with a relief on its surface, sliced as `slice_part` does: gray as height on faces that look up, as lateral
/// growth on walls. The part is placed as it is without its relief, which then reaches out of it.
///
/// Costs    memory does not grow with the number of layers or micro-triangles.
/// Errors   InvalidInput as `slice_part`, and where the relief reaches out of the printer's field.
[[nodiscard]] SliceSummary slice_clothed(const PartMesh& part, SmoothSurface surface, SurfaceRelief relief,
                                         const PrinterProfile& profile, const SliceOptions& options,
                                         const PackLayer& pack, const TakeLayer& take, const Progress& progress = {});

}  // namespace mezzotint
