#pragma once

#include <string>

#include "fabrication/job/layer_picture.h"

namespace mezzotint {

/// A layer as an 8-bit gray PNG, row 0 on top (y = 0 at the bottom). The same layer gives the same bytes.
///
/// Costs    grows with the runs of the picture, not with its pixels: an empty layer of 4 million pixels takes
///          70 µs where zlib takes 8 ms or more (docs/slicing.md has the race). Where most pixels differ from their
///          neighbours, libdeflate packs bytes.
/// Source   Portable Network Graphics, 2nd edition (ISO/IEC 15948:2004).
[[nodiscard]] std::string encode_layer_png(const LayerPicture& picture);

}  // namespace mezzotint
