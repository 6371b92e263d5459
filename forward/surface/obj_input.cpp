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

}  // namespace

RawMesh parse_obj(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  RawMesh mesh{.format = "obj"};
  TextWords text(bytes);
  std::vector<std::uint32_t> corners;
  while (text.next_line(true)) {
    const std::string_view keyword = text.word();
    if (keyword == "v")
      read_vertex(path, text, mesh);
    else if (keyword == "f")
      read_face(path, text, corners, mesh);
    else if (keyword == "#" && text.rest().starts_with(our_unit))
      mesh.unit = Length::from_um(1.0);
  }
  return mesh;
}

}  // namespace mezzotint
