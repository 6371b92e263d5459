#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace mezzotint {

/// A part as triangles: what is read from a mesh file, mended, sliced and clothed with a pattern.
///
/// Frame    the machine's: x along a projector row, y along a column, z up from the platform. Triangles are
///          counter-clockwise seen from outside the material.
/// Units    millimetres, in double.
struct PartMesh {
  std::vector<std::array<double, 3>> vertices_mm;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  /// Which group of faces a triangle is in (an index into `group_names`); empty where the file has no groups.
  std::vector<std::uint32_t> groups;
  std::vector<std::string> group_names;
};

}  // namespace mezzotint
