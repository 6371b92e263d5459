#pragma once

#include <string>

#include "fabrication/job/layer_picture.h"

namespace mezzotint {

// The two sizes that PrusaSlicer and UVtools give to the previews of an archive.
inline constexpr std::size_t tiny_columns = 400, tiny_rows = 400;
inline constexpr std::size_t huge_columns = 800, huge_rows = 480;

/// A layer, as large as it fits, in the middle of a black RGB picture.
[[nodiscard]] std::string preview_png(const LayerPicture& layer, std::size_t columns, std::size_t rows);

}  // namespace mezzotint
