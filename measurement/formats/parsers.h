#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>

#include "measurement/formats/surface_file.h"

namespace mezzotint {

// One parser a format, on the whole file's bytes; `path` is for complaints only.
// @throws FileError, see read_surface.
[[nodiscard]] SurfaceFile parse_al3d(const std::filesystem::path& path, std::span<const std::byte> bytes);
[[nodiscard]] SurfaceFile parse_x3p(const std::filesystem::path& path, std::span<const std::byte> bytes);
[[nodiscard]] SurfaceFile parse_gwy(const std::filesystem::path& path, std::span<const std::byte> bytes);
[[nodiscard]] SurfaceFile parse_sur(const std::filesystem::path& path, std::span<const std::byte> bytes);
[[nodiscard]] SurfaceFile parse_sdf(const std::filesystem::path& path, std::span<const std::byte> bytes);
[[nodiscard]] SurfaceFile parse_opd(const std::filesystem::path& path, std::span<const std::byte> bytes);

/// The channel /N/data of a .gwy; without a number the first.
[[nodiscard]] SurfaceFile parse_gwy_channel(const std::filesystem::path& path, std::span<const std::byte> bytes,
                                            const std::optional<std::uint32_t>& wanted);

// Whether the first bytes are those of the format.
[[nodiscard]] bool looks_like_al3d(std::span<const std::byte> bytes);
[[nodiscard]] bool looks_like_x3p(std::span<const std::byte> bytes);
[[nodiscard]] bool looks_like_gwy(std::span<const std::byte> bytes);
[[nodiscard]] bool looks_like_sur(std::span<const std::byte> bytes);
[[nodiscard]] bool looks_like_sdf(std::span<const std::byte> bytes);
[[nodiscard]] bool looks_like_opd(std::span<const std::byte> bytes);

/// Adds a sentence to what was assumed.
void add_assumption(std::string& assumptions, std::string_view sentence);

}  // namespace mezzotint
