#include "fabrication/part/part_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "fabrication/part/three_mf_input.h"
#include "forward/base/error.h"
#include "forward/surface/raw_mesh.h"
#include "forward/surface/vertex_welder.h"

namespace mezzotint {

namespace {

std::string ending_of(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

// The vertices that triangles use, one for each place, in the order of first use.
void weld(RawMesh& raw) {
  constexpr auto not_used = std::numeric_limits<std::uint32_t>::max();
  VertexWelder welder(raw.vertices.size());
  std::vector<std::uint32_t> numbers(raw.vertices.size(), not_used);
  for (auto& triangle : raw.triangles) {
    for (std::uint32_t& corner : triangle) {
      if (numbers[corner] == not_used) numbers[corner] = welder.number(raw.vertices[corner]).value;
      corner = numbers[corner];
    }
  }
  raw.vertices = welder.take_vertices();
}

Length unit_of(const RawMesh& raw, const PartReadOptions& options, std::vector<std::string>& notes) {
  if (options.unit) return *options.unit;
  if (raw.unit) return *raw.unit;
  if (!raw.format.starts_with("stl")) notes.emplace_back("a number is worth 1 mm, as the file names no unit");
  return Length::from_mm(1.0);
}

void scale(const std::filesystem::path& path, double factor, std::vector<std::array<double, 3>>& vertices) {
  for (auto& vertex : vertices) {
    for (double& coordinate : vertex) {
      coordinate *= factor;
      // Areas and volumes are made of squares and cubes, which a double must hold.
      constexpr double largest_mm = 1e9;
      if (!(std::abs(coordinate) <= largest_mm))
        throw FileError(path, "", "reaches further than 1000 km; check its unit");
    }
  }
}

}  // namespace

bool is_part_path(const std::filesystem::path& path) {
  const std::string ending = ending_of(path);
  return ending == ".stl" || ending == ".obj" || ending == ".ply" || ending == ".3mf";
}

PartFile read_part(const std::filesystem::path& path, const PartReadOptions& options) {
  require(!options.unit || (options.unit->mm() > 0.0 && std::isfinite(options.unit->mm())),
          "the unit of a part must be a positive length");
  if (!is_part_path(path)) throw FileError(path, "", "is no part by its ending; .stl, .obj, .ply and .3mf are read");
  PartFile file;
  RawMesh raw = ending_of(path) == ".3mf" ? read_three_mf(path, file.notes) : read_raw_mesh(path);
  if (raw.triangles.empty()) throw FileError(path, "", "has no triangle; a part needs a closed surface of them");
  file.format = raw.format;
  if (raw.left_out > 0)
    file.notes.push_back(fmt::format("{} faces of fewer than three corners were left out", raw.left_out));
  if (!raw.format.starts_with("stl")) weld(raw);
  scale(path, unit_of(raw, options, file.notes).mm(), raw.vertices);
  file.mesh = {std::move(raw.vertices), std::move(raw.triangles), std::move(raw.groups), std::move(raw.group_names)};
  return file;
}

}  // namespace mezzotint
