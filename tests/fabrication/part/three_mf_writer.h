#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <zip.h>

#include "fabrication/part/part_mesh.h"

namespace mezzotint::test {

inline void add_member(zip_t* archive, const char* name, const std::string& text) {
  zip_source_t* source = zip_source_buffer(archive, text.data(), text.size(), 0);
  if (source == nullptr || zip_file_add(archive, name, source, 0) < 0) throw std::runtime_error("no zip member");
}

/// A 3MF package about the text of a model.
inline void write_three_mf(const std::filesystem::path& path, const std::string& model) {
  const std::string types =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?><Types "
      "xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\"><Default Extension=\"rels\" "
      "ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/><Default Extension=\"model\" "
      "ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/></Types>";
  const std::string relations =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?><Relationships "
      "xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\"><Relationship "
      "Target=\"/3D/3dmodel.model\" "
      "Id=\"rel0\" Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>";
  int problem = 0;
  zip_t* archive = zip_open(path.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &problem);
  if (archive == nullptr) throw std::runtime_error("no zip archive");
  add_member(archive, "[Content_Types].xml", types);
  add_member(archive, "_rels/.rels", relations);
  add_member(archive, "3D/3dmodel.model", model);
  if (zip_close(archive) != 0) throw std::runtime_error("no zip archive");
}

inline std::string model_text(const std::string& unit, const std::string& resources, const std::string& build) {
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?><model unit=\"{}\" xml:lang=\"en-US\" "
      "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"><resources>{}</resources>"
      "<build>{}</build></model>",
      unit, resources, build);
}

inline std::string object_text(int id, const std::string& name, const PartMesh& mesh) {
  std::string text = fmt::format("<object id=\"{}\" name=\"{}\" type=\"model\"><mesh><vertices>", id, name);
  for (const auto& v : mesh.vertices_mm) text += fmt::format("<vertex x=\"{}\" y=\"{}\" z=\"{}\"/>", v[0], v[1], v[2]);
  text += "</vertices><triangles>";
  for (const auto& t : mesh.triangles)
    text += fmt::format("<triangle v1=\"{}\" v2=\"{}\" v3=\"{}\"/>", t[0], t[1], t[2]);
  return text + "</triangles></mesh></object>";
}

}  // namespace mezzotint::test
