#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "forward/base/units.h"
#include "forward/surface/mesh.h"

namespace mezzotint {

/// A triangle mesh that was read, and what had to be assumed to read it.
struct MeshFile {
  TriangleMesh mesh;  ///< without normals: those of a file are not read
  std::string format;
  std::string assumption;  ///< what the file did not say or was not taken as it stood; empty where nothing
};

/// Whether a path's ending is that of a mesh: .obj, .ply or .stl, in any case.
[[nodiscard]] bool is_mesh_path(const std::filesystem::path& path);

/// Reads Wavefront OBJ, PLY (text, binary of either order) and STL (text, binary).
///
/// Frame    as in the file. Far from the origin it is moved there (in double), so that single precision is spent on
///          the mesh, and `assumption` says so. Triangles keep their orientation; that counter-clockwise seen from
///          outside is outwards is the file's promise. The normals of an STL and of vertices are not looked at.
/// Shape    polygons are split in a fan from their first corner (right for convex ones). Corners of an STL at exactly
///          the same place are one vertex. Faces of fewer than three corners and triangles without area are left out.
/// Units    micrometres. None of the formats has a unit: `unit` is what a number in the file is worth; without it,
///          what the comment of our own OBJ says, 1 mm for STL, 1 µm for the others; `assumption` says so.
/// Errors   FileError with line or byte for what is truncated, an index that names no vertex, numbers that are none or
///          not finite, no triangle at all, more than 2^28 vertices or triangles; sizes are checked against the file's
///          before memory is taken.
[[nodiscard]] MeshFile read_mesh(const std::filesystem::path& path, std::optional<Length> unit = {});

}  // namespace mezzotint
