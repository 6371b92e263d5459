#include "measurement/formats/al3d_folder.h"

#include <limits>

#include <fmt/format.h>
#include <pugixml.hpp>

#include "forward/base/error.h"
#include "forward/base/file_input.h"
#include "measurement/formats/quality_map.h"
#include "measurement/formats/text_values.h"

namespace mezzotint {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t most_entries = 200;

// The leaves of the document, each under the names that lead to it.
void collect(const pugi::xml_node& node, const std::string& place, int depth,
             std::map<std::string, std::string>& entries) {
  constexpr int deepest = 16;
  for (const pugi::xml_node& child : node.children()) {
    if (child.type() != pugi::node_element || depth == deepest || entries.size() >= most_entries) continue;
    const std::string name = place.empty() ? child.name() : place + "/" + child.name();
    const std::string text = clean_text(child.text().get());
    if (!text.empty()) entries["info.xml " + clean_text(name)] = text;
    collect(child, name, depth + 1, entries);
  }
}

}  // namespace

bool is_al3d_folder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored) && fs::is_regular_file(al3d_of_folder(path), ignored);
}

fs::path al3d_of_folder(const fs::path& folder) { return folder / "dem.al3d"; }

void add_al3d_information(const fs::path& folder, SurfaceFile& surface) {
  const fs::path path = folder / "info.xml";
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return;
  try {
    const auto bytes = read_file(path);
    pugi::xml_document document;
    const pugi::xml_parse_result result = document.load_buffer(bytes.data(), bytes.size());
    if (!result) throw FileError(path, fmt::format("byte {}", result.offset), result.description());
    collect(document.document_element(), "", 0, surface.provenance);
  } catch (const FileError& error) {
    surface.provenance["info.xml"] = clean_text(std::string("cannot be used: ") + error.what());
  }
}

bool has_quality_map(const fs::path& folder) {
  std::error_code ignored;
  return fs::is_regular_file(folder / "qualitymap.bmp", ignored);
}

QualityMap read_quality_map(const fs::path& folder, const HeightField& field) {
  const fs::path path = folder / "qualitymap.bmp";
  if (!has_quality_map(folder))
    throw FileError(path, "", "no such file; a threshold of quality needs the map beside the heights");
  QualityMap map = parse_quality_map(path, read_file(path));
  if (map.columns != field.columns() || map.rows != field.rows()) {
    throw FileError(path, "",
                    fmt::format("has {} × {} pixels; the {} × {} of the heights are needed", map.columns, map.rows,
                                field.columns(), field.rows()));
  }
  return map;
}

void mask_low_quality(const fs::path& folder, int min_quality, SurfaceFile& surface) {
  HeightField& field = surface.field;
  const QualityMap map = read_quality_map(folder, field);
  for (std::size_t row = 0; row < map.rows; ++row) {
    for (std::size_t column = 0; column < map.columns; ++column) {
      if (map.gray[(map.rows - 1 - row) * map.columns + column] >= min_quality) continue;
      field.at(column, row) = std::numeric_limits<float>::quiet_NaN();
    }
  }
  surface.provenance["minimum quality"] = std::to_string(min_quality);
}

}  // namespace mezzotint
