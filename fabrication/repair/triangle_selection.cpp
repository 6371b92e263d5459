#include "fabrication/repair/triangle_selection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "fabrication/part/edge_table.h"
#include "fabrication/part/triangle_geometry.h"

namespace mezzotint {

namespace {

using Triangle = std::array<std::uint32_t, 3>;

// Even permutations of sorted corners face the same way.
bool faces_as_sorted(const Triangle& triangle, const Triangle& sorted) {
  const auto at = static_cast<std::size_t>(std::find(triangle.begin(), triangle.end(), sorted[0]) - triangle.begin());
  return triangle[(at + 1) % 3] == sorted[1];
}

double squared_distance(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  double sum = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) sum += (a[axis] - b[axis]) * (a[axis] - b[axis]);
  return sum;
}

std::vector<std::uint32_t> open_vertices(const PartMesh& mesh) {
  std::vector<std::uint32_t> open;
  EdgeTable(mesh).for_each_edge([&](std::uint32_t low, std::span<const EdgeTable::Side> sides) {
    if (sides.size() == 1) open.insert(open.end(), {low, sides[0].high});
  });
  std::sort(open.begin(), open.end());
  open.erase(std::unique(open.begin(), open.end()), open.end());
  return open;
}

}  // namespace

void keep_triangles(PartMesh& mesh, const std::vector<bool>& wanted) {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
    if (!wanted[k]) continue;
    mesh.triangles[kept] = mesh.triangles[k];
    if (!mesh.groups.empty()) mesh.groups[kept] = mesh.groups[k];
    ++kept;
  }
  mesh.triangles.resize(kept);
  if (!mesh.groups.empty()) mesh.groups.resize(kept);
}

std::size_t remove_collapsed(PartMesh& mesh) {
  const std::size_t before = mesh.triangles.size();
  std::vector<bool> wanted(before);
  for (std::size_t k = 0; k < before; ++k) wanted[k] = !is_collapsed(mesh.triangles[k]);
  keep_triangles(mesh, wanted);
  return before - mesh.triangles.size();
}

std::size_t remove_duplicates(PartMesh& mesh) {
  const std::size_t before = mesh.triangles.size();
  struct Entry {
    Triangle sorted;
    std::uint32_t number;
  };
  std::vector<Entry> entries(before);
  for (std::uint32_t k = 0; k < before; ++k) {
    entries[k] = {mesh.triangles[k], k};
    std::sort(entries[k].sorted.begin(), entries[k].sorted.end());
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return a.sorted < b.sorted || (a.sorted == b.sorted && a.number < b.number);
  });
  std::vector<bool> wanted(before, false);
  for (std::size_t begin = 0, end = 0; begin < before; begin = end) {
    int balance = 0;
    for (end = begin; end < before && entries[end].sorted == entries[begin].sorted; ++end)
      balance += faces_as_sorted(mesh.triangles[entries[end].number], entries[end].sorted) ? 1 : -1;
    for (std::size_t k = begin; k < end && balance != 0; ++k) {
      if (faces_as_sorted(mesh.triangles[entries[k].number], entries[k].sorted) != (balance > 0)) continue;
      wanted[entries[k].number] = true;
      break;
    }
  }
  keep_triangles(mesh, wanted);
  return before - mesh.triangles.size();
}

std::size_t join_open_vertices(PartMesh& mesh, double distance_mm) {
  if (!(distance_mm > 0.0)) return 0;
  std::map<std::array<std::int64_t, 3>, std::vector<std::uint32_t>> cells;  // of vertices that stay
  std::vector<std::uint32_t> numbers(mesh.vertices_mm.size());
  std::iota(numbers.begin(), numbers.end(), 0U);
  std::size_t joined = 0;
  for (const std::uint32_t vertex : open_vertices(mesh)) {
    const auto& place = mesh.vertices_mm[vertex];
    std::array<std::int64_t, 3> cell{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      cell[axis] = static_cast<std::int64_t>(std::floor(place[axis] / distance_mm));
    std::uint32_t nearest = vertex;
    double least = distance_mm * distance_mm;
    for (int k = 0; k < 27; ++k) {
      const auto found = cells.find({cell[0] + k % 3 - 1, cell[1] + k / 3 % 3 - 1, cell[2] + k / 9 - 1});
      if (found == cells.end()) continue;
      for (const std::uint32_t other : found->second) {
        const double squared = squared_distance(place, mesh.vertices_mm[other]);
        if (squared > least || (squared == least && nearest != vertex)) continue;
        least = squared;
        nearest = other;
      }
    }
    numbers[vertex] = nearest;
    if (nearest == vertex)
      cells[cell].push_back(vertex);
    else
      ++joined;
  }
  if (joined == 0) return 0;
  for (Triangle& triangle : mesh.triangles)
    for (std::uint32_t& corner : triangle) corner = numbers[corner];
  return joined;
}

void remove_unused_vertices(PartMesh& mesh) {
  constexpr auto unused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> numbers(mesh.vertices_mm.size(), unused);
  for (const Triangle& triangle : mesh.triangles)
    for (const std::uint32_t corner : triangle) numbers[corner] = 0;
  std::uint32_t next = 0;
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    if (numbers[k] == unused) continue;
    mesh.vertices_mm[next] = mesh.vertices_mm[k];
    numbers[k] = next++;
  }
  mesh.vertices_mm.resize(next);
  for (Triangle& triangle : mesh.triangles)
    for (std::uint32_t& corner : triangle) corner = numbers[corner];
}

}  // namespace mezzotint
