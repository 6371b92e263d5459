#pragma once

#include <optional>
#include <string_view>

#include "measurement/formats/height_assembly.h"
#include "measurement/formats/sidecar.h"
#include "measurement/formats/surface_file.h"

namespace mezzotint {

// Formats that know no sizes: each is read with its sidecar.
// @throws FileError, see read_surface; also where the sidecar lacks what the format needs.

/// Numbers row by row, separated by commas, semicolons, tabs or blanks; lines with # or % are comments.
[[nodiscard]] SurfaceFile parse_csv(const std::filesystem::path& path, std::span<const std::byte> bytes,
                                    const Sidecar& sidecar);
/// Lines of x, y, z on a regular grid, in any order; points that are not listed are missing.
[[nodiscard]] SurfaceFile parse_xyz(const std::filesystem::path& path, std::span<const std::byte> bytes,
                                    const Sidecar& sidecar);
/// PNG, TIFF or OpenEXR: one channel of 8 or 16 bits of gray, or of 32-bit floats.
[[nodiscard]] SurfaceFile parse_picture(const std::filesystem::path& path, std::span<const std::byte> bytes,
                                        const Sidecar& sidecar);

[[nodiscard]] bool looks_like_picture(std::span<const std::byte> bytes);

// What they share.
[[nodiscard]] Grid sidecar_grid(const std::filesystem::path& path, const Sidecar& sidecar, std::uint64_t columns,
                                std::uint64_t rows);
[[nodiscard]] double required_scale_um(const std::filesystem::path& path, const std::optional<double>& value,
                                       std::string_view key);
[[nodiscard]] Continuation sidecar_continuation(const Sidecar& sidecar);

}  // namespace mezzotint
