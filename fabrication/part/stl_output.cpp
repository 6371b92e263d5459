#include <bit>
#include <cmath>
#include <string>

#include "fabrication/part/part_file.h"
#include "fabrication/part/triangle_geometry.h"
#include "forward/base/error.h"
#include "forward/base/file_output.h"

namespace mezzotint {

namespace {

void put_word(std::string& bytes, std::uint32_t word) {
  for (unsigned k = 0; k < 4; ++k) bytes.push_back(static_cast<char>((word >> (8U * k)) & 0xFFU));
}

void put(std::string& bytes, const std::array<double, 3>& vector) {
  for (const double value : vector) put_word(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(value)));
}

std::array<double, 3> unit_normal(const PartMesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  std::array<double, 3> normal = doubled_area_vector(mesh, triangle);
  const double length = std::hypot(normal[0], normal[1], normal[2]);
  for (double& value : normal) value = length > 0.0 ? value / length : 0.0;
  return normal;
}

}  // namespace

void write_stl(const PartMesh& mesh, const std::filesystem::path& path) {
  require(!mesh.triangles.empty(), "a part without triangles cannot be written as STL");
  require(mesh.triangles.size() < (std::size_t{1} << 32U), "an STL holds fewer than 2^32 triangles");
  const std::string ending = path.extension().string();
  require(ending == ".stl" || ending == ".STL", path.string() + ": a part is written as .stl");
  write_pieces(path, [&](const PutBytes& put_bytes) {
    constexpr std::size_t piece = std::size_t{1} << 20U;
    std::string bytes = "binary STL by Mezzotint, millimetres";  // must not begin with "solid"
    bytes.resize(80, ' ');
    put_word(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
    for (const auto& triangle : mesh.triangles) {
      put(bytes, unit_normal(mesh, triangle));
      for (const std::uint32_t corner : triangle) put(bytes, mesh.vertices_mm[corner]);
      bytes.append(2, '\0');
      if (bytes.size() < piece) continue;
      put_bytes(bytes);
      bytes.clear();
    }
    put_bytes(bytes);
  });
}

}  // namespace mezzotint
