#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "forward/base/units.h"

namespace mezzotint {

/// What a mesh file holds, as it stands there: nothing moved, scaled, rounded or left out but faces of fewer than three
/// corners.
///
/// Frame    the file's; triangles keep their orientation.
/// Shape    polygons are split in a fan from their first corner (right for convex ones). Corners of an STL at exactly
///          the same place are one vertex; those of OBJ and PLY are the file's own.
/// Units    the file's: `unit` where the file says what a number is worth.
struct RawMesh {
  std::vector<std::array<double, 3>> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  /// Which group a triangle is in (an index into `group_names`); empty where the file has no groups. Only OBJ has:
  /// the names of its object, group and material ("o", "g", "usemtl"), joined by '/'.
  std::vector<std::uint32_t> groups;
  std::vector<std::string> group_names;
  std::string format;
  std::optional<Length> unit;
  std::size_t left_out = 0;  ///< faces of fewer than three corners
};

/// Reads OBJ, PLY (text, binary of either order) and STL (text, binary), by the path's ending.
/// @throws FileError with line or byte for what is truncated, an index that names no vertex, numbers that are none or
///         not finite, more than 2^28 vertices or triangles; sizes are checked against the file's before memory is
///         taken.
[[nodiscard]] RawMesh read_raw_mesh(const std::filesystem::path& path);

}  // namespace mezzotint
