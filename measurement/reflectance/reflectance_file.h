#pragma once

#include <filesystem>

#include "measurement/reflectance/measured_reflectance.h"

namespace mezzotint {

/// A measured BRDF of any format that we know, told by its content: RGL tensor (.bsdf), MERL (.binary), Zemax BSDF,
/// FRED BSDF, Cornell and ALTA text. docs/files.md says what is read of each.
/// @throws FileError, see reflectance_parsers.h.
[[nodiscard]] MeasuredReflectance read_reflectance(const std::filesystem::path& path);

/// Whether a file begins like one of them; false for what cannot be read.
[[nodiscard]] bool is_reflectance_file(const std::filesystem::path& path);

}  // namespace mezzotint
