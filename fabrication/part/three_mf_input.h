#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "forward/surface/raw_mesh.h"

/// Inside of fabrication/part.

namespace mezzotint {

/// The objects of a 3MF file's build, in millimetres; `notes` gets the library's warnings.
/// @throws FileError (see read_part)
[[nodiscard]] RawMesh read_three_mf(const std::filesystem::path& path, std::vector<std::string>& notes);

}  // namespace mezzotint
