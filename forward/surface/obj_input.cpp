#include <map>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "forward/surface/mesh_parsers.h"
#include "forward/surface/text_words.h"

namespace mezzotint {

namespace {

constexpr std::string_view our_unit = " Mezzotint: micrometres";

void read_vertex(const std::filesystem::path& path, TextWords& text, RawMesh& mesh) {
  std::array<double, 3> vertex{};
  for (double& coordinate : vertex) {
    const std::string_view word = text.word();
    const auto value = real_in(word);
    if (!value) throw FileError(path, text.place(), fmt::format("a vertex needs three numbers; \"{}\" is none", word));
    coordinate = *value;
  }
  add_vertex(path, text.place(), vertex, mesh);
}

// The vertex of "7", "7/1", "7//3" or "7/1/3"; −1 is the last one so far.
std::uint32_t vertex_of(const std::filesystem::path& path, const TextWords& text, std::string_view corner,
                        std::size_t count) {
  const auto index = integer_in(corner.substr(0, corner.find('/')));
  if (!index) throw FileError(path, text.place(), fmt::format("\"{}\" is no corner of a face", corner));
  const auto known = static_cast<long long>(count);
  const long long number = *index < 0 ? known + *index : *index - 1;
  if (*index == 0 || number < 0 || number >= known) {
    throw FileError(path, text.place(), fmt::format("a face names vertex {}; there are {} before it", *index, count));
  }
  return static_cast<std::uint32_t>(number);
}

void read_face(const std::filesystem::path& path, TextWords& text, std::vector<std::uint32_t>& corners, RawMesh& mesh) {
  corners.clear();
  for (std::string_view word = text.word(); !word.empty(); word = text.word()) {
    if (word.starts_with('#')) break;
    corners.push_back(vertex_of(path, text, word, mesh.vertices.size()));
  }
  add_polygon(corners, mesh);
}

/// Which object, group and material the file is at, and the number of their joined names.
class Groups {
public:
  /// @param kind 0 object, 1 group, 2 material
  void enter(std::size_t kind, TextWords& text) {
    names_[kind].clear();
    for (std::string_view word = text.word(); !word.empty(); word = text.word())
      names_[kind].append(names_[kind].empty() ? "" : " ").append(word);
    current_.reset();
  }
  /// Gives the triangles without a group the one that the file is at.
  void mark(RawMesh& mesh) {
    if (!current_) current_ = find(mesh);
    mesh.groups.resize(mesh.triangles.size(), *current_);
  }

private:
  std::uint32_t find(RawMesh& mesh) {
    std::string joined;
    for (const std::string& name : names_)
      if (!name.empty()) joined.append(joined.empty() ? "" : "/").append(name);
    const auto [known, is_new] = numbers_.try_emplace(joined, static_cast<std::uint32_t>(numbers_.size()));
    if (is_new) mesh.group_names.push_back(joined);
    return known->second;
  }

  std::array<std::string, 3> names_;
  std::map<std::string, std::uint32_t> numbers_;
  std::optional<std::uint32_t> current_;
};

std::optional<std::size_t> kind_of_group(std::string_view keyword) {
  if (keyword == "o") return 0;
  if (keyword == "g") return 1;
  if (keyword == "usemtl") return 2;
  return std::nullopt;
}

}  // namespace

RawMesh parse_obj(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  RawMesh mesh{.format = "obj"};
  TextWords text(bytes);
  std::vector<std::uint32_t> corners;
  Groups groups;
  while (text.next_line(true)) {
    const std::string_view keyword = text.word();
    if (keyword == "v")
      read_vertex(path, text, mesh);
    else if (keyword == "f") {
      read_face(path, text, corners, mesh);
      groups.mark(mesh);
    } else if (const auto kind = kind_of_group(keyword))
      groups.enter(*kind, text);
    else if (keyword == "#" && text.rest().starts_with(our_unit))
      mesh.unit = Length::from_um(1.0);
  }
  if (mesh.group_names.size() < 2 && (mesh.group_names.empty() || mesh.group_names[0].empty())) {
    mesh.groups.clear();  // the file names no group
    mesh.group_names.clear();
  }
  return mesh;
}

}  // namespace mezzotint
