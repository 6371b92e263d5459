#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fabrication/part/part_mesh.h"
#include "forward/base/units.h"

namespace mezzotint {

struct PartReadOptions {
  /// What a number in the file is worth. Without it: what the file says (3MF, the comment of our own OBJ), else 1 mm.
  std::optional<Length> unit;
};

/// A part that was read, and what must be known before it is trusted.
struct PartFile {
  PartMesh mesh;
  std::string format;
  /// What had to be assumed or was left out, and what the library for 3MF warns of; sentences for the user.
  std::vector<std::string> notes;
};

/// Reads STL (binary, text: told apart by content), OBJ, PLY (text, binary of either order) and 3MF, by the ending.
///
/// Frame    the file's, unmoved. A 3MF's objects stand where its build places them, their components transformed.
/// Shape    corners at exactly the same place are one vertex (−0 is 0), in the order of first use; vertices that no
///          triangle uses are left out. Polygons become fans from their first corner. Groups: see `RawMesh`; of a 3MF,
///          a group is an item of its build.
/// Errors   FileError with line or byte, as `read_raw_mesh`; where there is no triangle; where a 3MF is none, has
///          nothing to build, or is larger than a number can tell. What it warns of but can still be read is a note.
[[nodiscard]] PartFile read_part(const std::filesystem::path& path, const PartReadOptions& options = {});

/// Whether a path's ending is that of a part: .stl, .obj, .ply or .3mf, in any case.
[[nodiscard]] bool is_part_path(const std::filesystem::path& path);

/// A binary STL in millimetres, aside then renamed; normals from the triangles, groups are lost.
/// @throws InvalidInput for an empty mesh, a path that does not end in .stl, or more than 2^32 − 1 triangles
/// @throws DeviceError where it cannot be written
void write_stl(const PartMesh& mesh, const std::filesystem::path& path);

}  // namespace mezzotint
