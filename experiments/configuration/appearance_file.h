#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fabrication/appearance/appearance.h"

namespace mezzotint {

/// The file of `mezzotint slice --appearance`: `[pattern]`, `[field]`, `[surface]`, `[picture]` and `[[region]]`.
/// @throws ConfigurationError
[[nodiscard]] Appearance read_appearance(const std::filesystem::path& path,
                                         const std::vector<std::string>& settings = {});

}  // namespace mezzotint
