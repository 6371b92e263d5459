#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "forward/surface/raw_mesh.h"

/// Inside of forward/surface: the formats of meshes.

namespace mezzotint {

inline constexpr std::size_t most_mesh_elements = std::size_t{1} << 28;

/// @throws FileError (see read_raw_mesh); `path` is only named.
[[nodiscard]] RawMesh parse_obj(const std::filesystem::path& path, std::span<const std::byte> bytes);
[[nodiscard]] RawMesh parse_ply(const std::filesystem::path& path, std::span<const std::byte> bytes);
[[nodiscard]] RawMesh parse_stl(const std::filesystem::path& path, std::span<const std::byte> bytes);

/// Adds a polygon as a fan; corners are numbers of vertices.
void add_polygon(std::span<const std::uint32_t> corners, RawMesh& mesh);
[[noreturn]] void refuse_vertex(const std::filesystem::path& path, const std::string& place);
/// Checks that a vertex was read whole and finite, and adds it.
void add_vertex(const std::filesystem::path& path, const std::string& place, const std::array<double, 3>& vertex,
                RawMesh& mesh);

}  // namespace mezzotint
