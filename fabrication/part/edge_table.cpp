#include "fabrication/part/edge_table.h"

#include <algorithm>
#include <numeric>

#include "fabrication/part/triangle_geometry.h"
#include "forward/base/error.h"

namespace mezzotint {

namespace {

constexpr std::size_t most_triangles = std::size_t{1} << 30U;

void check(const PartMesh& mesh) {
  require(mesh.triangles.size() <= most_triangles, "a part has at most 2^30 triangles");
  const std::size_t count = mesh.vertices_mm.size();
  for (const auto& triangle : mesh.triangles)
    require(std::max({triangle[0], triangle[1], triangle[2]}) < count, "a triangle of a part names no vertex of it");
}

template <class Visit>
void for_each_side(const PartMesh& mesh, const Visit& visit) {
  for (std::uint32_t number = 0; number < mesh.triangles.size(); ++number) {
    const auto& triangle = mesh.triangles[number];
    if (is_collapsed(triangle)) continue;
    for (std::size_t k = 0; k < 3; ++k) visit(number, triangle[k], triangle[(k + 1) % 3]);
  }
}

std::uint32_t root_of(std::vector<std::uint32_t>& parents, std::uint32_t member) {
  while (parents[member] != member) {
    parents[member] = parents[parents[member]];
    member = parents[member];
  }
  return member;
}

}  // namespace

EdgeTable::EdgeTable(const PartMesh& mesh) {
  check(mesh);
  const auto begin_with = [](Side a, Side b) {
    return a.high < b.high || (a.high == b.high && a.triangle < b.triangle);
  };
  begins_.assign(mesh.vertices_mm.size() + 1, 0);
  for_each_side(mesh, [&](std::uint32_t, std::uint32_t from, std::uint32_t to) { ++begins_[std::min(from, to) + 1]; });
  std::partial_sum(begins_.begin(), begins_.end(), begins_.begin());
  sides_.resize(begins_.back());
  for_each_side(mesh, [&](std::uint32_t number, std::uint32_t from, std::uint32_t to) {
    sides_[begins_[std::min(from, to)]++] = {std::max(from, to), 2 * number + (from > to ? 1U : 0U)};
  });
  // Each beginning has moved to the next one.
  std::copy_backward(begins_.begin(), begins_.end() - 1, begins_.end());
  begins_[0] = 0;
  for (std::size_t low = 0; low + 1 < begins_.size(); ++low)
    std::sort(sides_.begin() + begins_[low], sides_.begin() + begins_[low + 1], begin_with);
}

Shells find_shells(const PartMesh& mesh, const EdgeTable& edges, Join join) {
  std::vector<std::uint32_t> parents(mesh.triangles.size());
  std::iota(parents.begin(), parents.end(), 0U);
  edges.for_each_edge([&](std::uint32_t, std::span<const EdgeTable::Side> sides) {
    if (sides.size() != 2 && join == Join::EdgesOfTwo) return;
    for (std::size_t k = 1; k < sides.size(); ++k) {
      const std::uint32_t a = root_of(parents, sides[k - 1].number()), b = root_of(parents, sides[k].number());
      parents[std::max(a, b)] = std::min(a, b);
    }
  });
  Shells shells;
  shells.of_triangle.assign(mesh.triangles.size(), Shells::none);
  for (std::uint32_t number = 0; number < mesh.triangles.size(); ++number) {
    if (is_collapsed(mesh.triangles[number])) continue;
    const std::uint32_t root = root_of(parents, number);  // never a later one
    shells.of_triangle[number] = root == number ? shells.count++ : shells.of_triangle[root];
  }
  return shells;
}

}  // namespace mezzotint
