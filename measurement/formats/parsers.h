#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "measurement/formats/surface_file.h"

namespace mezzotint {

// One parser a format, on the whole file's bytes; `path` is for complaints only.
// @throws FileError, see read_surface.
[[nodiscard]] SurfaceFile parse_al3d(const std::filesystem::path& path, std::span<const std::byte> bytes);
[[nodiscard]] SurfaceFile parse_x3p(const std::filesystem::path& path, std::span<const std::byte> bytes);
[[nodiscard]] SurfaceFile parse_gwy(const std::filesystem::path& path, std::span<const std::byte> bytes);

// Whether the first bytes are those of the format.
[[nodiscard]] bool looks_like_al3d(std::span<const std::byte> bytes);
[[nodiscard]] bool looks_like_x3p(std::span<const std::byte> bytes);
[[nodiscard]] bool looks_like_gwy(std::span<const std::byte> bytes);

/// Adds a sentence to what was assumed.
void add_assumption(std::string& assumptions, std::string_view sentence);

}  // namespace mezzotint
