#include "forward/surface/mesh_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "forward/base/file_input.h"
#include "forward/surface/mesh_parsers.h"

namespace mezzotint {

namespace {

// A mesh is moved where its distance from the origin exceeds its size by this: two bits of its coordinates.
constexpr double far_away = 4.0;

std::string ending_of(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

void note(std::string& assumption, const std::string& text) {
  if (!assumption.empty()) assumption += "; ";
  assumption += text;
}

Length unit_of(const RawMesh& raw, std::optional<Length> wanted, std::string& assumption) {
  if (wanted) return *wanted;
  if (raw.unit) return *raw.unit;
  const bool stl = raw.format.starts_with("stl");
  note(assumption,
       stl ? "a number is worth 1 mm, as STL has no unit" : "a number is worth 1 µm, as the file names no unit");
  return stl ? Length::from_mm(1.0) : Length::from_um(1.0);
}

struct Box {
  std::array<double, 3> low, high;
};

Box box_of(const RawMesh& raw) {
  Box box{raw.vertices.front(), raw.vertices.front()};
  for (const auto& vertex : raw.vertices) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.low[axis] = std::min(box.low[axis], vertex[axis]);
      box.high[axis] = std::max(box.high[axis], vertex[axis]);
    }
  }
  return box;
}

// What is taken from the coordinates: nothing, unless the mesh lies far from the origin.
std::array<double, 3> offset_of(const RawMesh& raw, std::string& assumption) {
  const Box box = box_of(raw);
  double size = 0.0, distance = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    size = std::max(size, box.high[axis] - box.low[axis]);
    distance = std::max({distance, std::abs(box.low[axis]), std::abs(box.high[axis])});
  }
  if (distance <= far_away * size) return {};
  note(assumption, fmt::format("moved by {:.9g}, {:.9g}, {:.9g} to the origin", -box.low[0], -box.low[1], -box.low[2]));
  return box.low;
}

bool has_area(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  std::array<double, 3> u{}, v{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double first = mesh.vertices_um[triangle[0]][axis];
    u[axis] = mesh.vertices_um[triangle[1]][axis] - first;
    v[axis] = mesh.vertices_um[triangle[2]][axis] - first;
  }
  return u[1] * v[2] != u[2] * v[1] || u[2] * v[0] != u[0] * v[2] || u[0] * v[1] != u[1] * v[0];
}

}  // namespace

void add_polygon(std::span<const std::uint32_t> corners, RawMesh& mesh) {
  if (corners.size() < 3) ++mesh.left_out;
  for (std::size_t k = 2; k < corners.size(); ++k) mesh.triangles.push_back({corners[0], corners[k - 1], corners[k]});
}

void refuse_vertex(const std::filesystem::path& path, const std::string& place) {
  throw FileError(path, place, "a vertex has a coordinate that is no finite number");
}

void add_vertex(const std::filesystem::path& path, const std::string& place, const std::array<double, 3>& vertex,
                RawMesh& mesh) {
  for (const double coordinate : vertex) {
    if (!std::isfinite(coordinate)) refuse_vertex(path, place);
  }
  if (mesh.vertices.size() == most_mesh_elements) throw FileError(path, place, "has more than 2^28 vertices");
  mesh.vertices.push_back(vertex);
}

bool is_mesh_path(const std::filesystem::path& path) {
  const std::string ending = ending_of(path);
  return ending == ".obj" || ending == ".ply" || ending == ".stl";
}

RawMesh read_raw_mesh(const std::filesystem::path& path) {
  const std::string ending = ending_of(path);
  if (!is_mesh_path(path)) throw FileError(path, "", "is no mesh by its ending; .obj, .ply and .stl are read");
  const std::vector<std::byte> bytes = read_file(path);
  if (ending == ".obj") return parse_obj(path, bytes);
  return ending == ".ply" ? parse_ply(path, bytes) : parse_stl(path, bytes);
}

MeshFile read_mesh(const std::filesystem::path& path, std::optional<Length> unit) {
  const RawMesh raw = read_raw_mesh(path);
  if (raw.triangles.empty()) throw FileError(path, "", "has no triangle");
  if (raw.triangles.size() > most_mesh_elements) throw FileError(path, "", "has more than 2^28 triangles");
  MeshFile file{.format = raw.format};
  const double scale = unit_of(raw, unit, file.assumption).um();
  const std::array<double, 3> offset = offset_of(raw, file.assumption);
  file.mesh.vertices_um.reserve(raw.vertices.size());
  for (const auto& vertex : raw.vertices) {
    std::array<float, 3> place{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      place[axis] = static_cast<float>((vertex[axis] - offset[axis]) * scale);
      if (!std::isfinite(place[axis])) throw FileError(path, "", "is larger than a number in micrometres can tell");
    }
    file.mesh.vertices_um.push_back(place);
  }
  for (const auto& triangle : raw.triangles)
    if (has_area(file.mesh, triangle)) file.mesh.triangles.push_back(triangle);
  const std::size_t left_out = raw.left_out + raw.triangles.size() - file.mesh.triangles.size();
  if (left_out > 0) note(file.assumption, fmt::format("{} faces without area left out", left_out));
  if (file.mesh.triangles.empty()) throw FileError(path, "", "has no triangle with an area");
  return file;
}

}  // namespace mezzotint
