#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <string_view>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "forward/base/file_output.h"
#include "forward/surface/mesh.h"

namespace mezzotint {

namespace {

bool one_word(const std::string& name) {
  return !name.empty() && std::none_of(name.begin(), name.end(), [](unsigned char c) { return std::isspace(c) != 0; });
}

void require_valid(const TriangleMesh& mesh, const ObjMaterial& material, const std::filesystem::path& path) {
  require(path.extension() == ".obj", path.string() + ": the name of a Wavefront file must end in .obj");
  require(one_word(material.name), "the name of a material must be one word without blanks");
  require(std::isfinite(material.index_of_refraction) && material.index_of_refraction > 0.0,
          "the index of refraction must be positive and finite");
  require(mesh.normals.size() == mesh.vertices_um.size(), "the mesh needs one normal a vertex");
}

std::string material_text(const ObjMaterial& material) {
  return fmt::format(
      "# Mezzotint: a clear relief\n"
      "newmtl {}\n"
      "Kd 0 0 0\n"
      "Ks 1 1 1\n"
      "Tf 1 1 1\n"
      "Ni {}\n"
      "illum 4\n",
      material.name, material.index_of_refraction);
}

void append_vectors(fmt::memory_buffer& text, std::string_view keyword,
                    const std::vector<std::array<float, 3>>& vectors) {
  for (const auto& v : vectors) {
    fmt::format_to(std::back_inserter(text), "{} {} {} {}\n", keyword, v[0], v[1], v[2]);
  }
}

void append_faces(fmt::memory_buffer& text, const std::vector<std::array<std::uint32_t, 3>>& triangles) {
  for (const auto& [a, b, c] : triangles) {  // Wavefront counts from 1
    fmt::format_to(std::back_inserter(text), "f {0}//{0} {1}//{1} {2}//{2}\n", a + 1, b + 1, c + 1);
  }
}

}  // namespace

void write_obj(const TriangleMesh& mesh, const ObjMaterial& material, const std::filesystem::path& path) {
  require_valid(mesh, material, path);
  std::filesystem::path material_path = path;
  material_path.replace_extension(".mtl");
  write_file(material_path, material_text(material));

  fmt::memory_buffer text;
  text.reserve(64 * (mesh.vertices_um.size() + mesh.triangles.size()));
  fmt::format_to(std::back_inserter(text), "# Mezzotint: micrometres, z out of the material\nmtllib {}\n",
                 material_path.filename().string());
  append_vectors(text, "v", mesh.vertices_um);
  append_vectors(text, "vn", mesh.normals);
  fmt::format_to(std::back_inserter(text), "usemtl {}\n", material.name);
  append_faces(text, mesh.triangles);
  write_file(path, std::string_view(text.data(), text.size()));
}

}  // namespace mezzotint
