#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "forward/surface/height_field.h"

namespace mezzotint {

/// A triangle mesh with one normal a vertex.
///
/// Frame    as HeightField; triangles counter-clockwise seen from +z.
/// Units    micrometres.
struct TriangleMesh {
  std::vector<std::array<float, 3>> vertices_um;
  std::vector<std::array<float, 3>> normals;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// The relief as a mesh: a vertex a sample, two triangles a cell, split along (c, r)–(c+1, r+1). Cells with
/// a missing corner are holes, and vertices that no triangle uses are left out. Normals are `pseudo_normals`;
/// those of a periodic field continue over its ends, though the cells that would close it are not in the mesh.
/// @throws InvalidInput for fewer than 2 × 2 samples, or when no whole cell is left.
[[nodiscard]] TriangleMesh to_mesh(const HeightField& field);

/// The same of a periodic field with the cells that close it: the mesh ends where its next copy begins.
/// @throws InvalidInput for a field that is not periodic, and as `to_mesh`.
[[nodiscard]] TriangleMesh to_closed_mesh(const HeightField& field);

/// One unit normal a sample, row after row: angle-weighted pseudo-normals of the mesh that `to_mesh` makes,
/// summed in double. Samples that no triangle uses get (0, 0, 1).
/// Source   Bærentzen & Aanæs, "Signed distance computation using the angle weighted pseudonormal", 2005.
[[nodiscard]] std::vector<std::array<float, 3>> pseudo_normals(const HeightField& field);

/// What stands in the material file beside an OBJ.
struct ObjMaterial {
  std::string name = "relief";
  double index_of_refraction = 1.5;  ///< Ni; illum 4 (transparency: glass on, reflection: ray trace on)
};

/// Wavefront OBJ with normals, and its MTL beside it under the same name. Each is written aside, then renamed;
/// the material first, so that an OBJ never names a file that is not there.
/// Units    micrometres; a float is written with the fewest digits that read back as the same float.
/// @throws InvalidInput for a path that does not end in .obj, a material name with blanks, an index of
///         refraction that is not positive and finite, or a mesh without one normal a vertex.
/// @throws DeviceError where they cannot be written.
void write_obj(const TriangleMesh& mesh, const ObjMaterial& material, const std::filesystem::path& path);

}  // namespace mezzotint
