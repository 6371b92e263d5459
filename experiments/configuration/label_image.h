#pragma once

#include <filesystem>

#include "forward/pattern/pattern.h"

namespace mezzotint {

/// Reads the labels of regions from a PNG picture: 8-bit gray, its top row at the largest y, at most 8192 pixels a
/// side.
///
/// Errors   FileError for a file that is missing, no PNG, in colour, or too large.
void read_label_image(const std::filesystem::path& path, PatternRegions& into);

}  // namespace mezzotint
