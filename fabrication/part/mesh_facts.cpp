#include "fabrication/part/mesh_facts.h"

#include <algorithm>
#include <cmath>

#include "fabrication/part/triangle_geometry.h"

namespace mezzotint {

namespace {

// Neumaier's sum.
class Sum {
public:
  void add(double term) {
    const double next = sum_ + term;
    lost_ += std::abs(sum_) >= std::abs(term) ? (sum_ - next) + term : (term - next) + sum_;
    sum_ = next;
  }
  [[nodiscard]] double value() const { return sum_ + lost_; }

private:
  double sum_ = 0.0, lost_ = 0.0;
};

void count_edges(const EdgeTable& edges, MeshFacts& facts) {
  edges.for_each_edge([&](std::uint32_t, std::span<const EdgeTable::Side> sides) {
    std::size_t down = 0;
    for (const EdgeTable::Side side : sides) down += side.walks_down() ? 1 : 0;
    if (2 * down != sides.size()) ++facts.unbalanced_edges;
    if (sides.size() == 1)
      ++facts.boundary_edges;
    else if (sides.size() > 2)
      ++facts.non_manifold_edges;
    else if (sides[0].walks_down() == sides[1].walks_down())
      ++facts.inconsistent_edges;
  });
}

void find_box(const PartMesh& mesh, MeshFacts& facts) {
  if (mesh.triangles.empty()) return;
  facts.low_mm = facts.high_mm = mesh.vertices_mm[mesh.triangles[0][0]];
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) {
      const auto& vertex = mesh.vertices_mm[corner];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        facts.low_mm[axis] = std::min(facts.low_mm[axis], vertex[axis]);
        facts.high_mm[axis] = std::max(facts.high_mm[axis], vertex[axis]);
      }
    }
  }
}

double longest_side_squared(const PartMesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  double longest = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto& from = mesh.vertices_mm[triangle[k]];
    const auto& to = mesh.vertices_mm[triangle[(k + 1) % 3]];
    double squared = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) squared += (to[axis] - from[axis]) * (to[axis] - from[axis]);
    longest = std::max(longest, squared);
  }
  return longest;
}

// Volume about `origin`: of the tetrahedra that it makes with the triangles.
void measure(const PartMesh& mesh, const std::array<double, 3>& origin, MeshFacts& facts) {
  constexpr double rounding = 1e-14;  // of a product of differences of doubles
  Sum area, volume;
  for (const auto& triangle : mesh.triangles) {
    const std::array<double, 3> normal = doubled_area_vector(mesh, triangle);
    const double doubled = std::sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    if (!(doubled > rounding * longest_side_squared(mesh, triangle))) ++facts.degenerate_triangles;
    area.add(0.5 * doubled);
    const auto& corner = mesh.vertices_mm[triangle[0]];
    for (std::size_t axis = 0; axis < 3; ++axis) volume.add((corner[axis] - origin[axis]) * normal[axis]);
  }
  facts.area_mm2 = area.value();
  facts.volume_mm3 = volume.value() / 6.0;
}

}  // namespace

MeshFacts mesh_facts(const PartMesh& mesh) {
  const EdgeTable edges(mesh);
  return mesh_facts(mesh, edges, find_shells(mesh, edges));
}

MeshFacts mesh_facts(const PartMesh& mesh, const EdgeTable& edges, const Shells& shells) {
  MeshFacts facts{.triangles = mesh.triangles.size(), .vertices = mesh.vertices_mm.size(), .bodies = shells.count};
  count_edges(edges, facts);
  find_box(mesh, facts);
  std::array<double, 3> origin{};
  // Far from the origin, large tetrahedra would cancel; only of a closed surface does the origin not matter.
  if (facts.closed())
    for (std::size_t axis = 0; axis < 3; ++axis) origin[axis] = 0.5 * (facts.low_mm[axis] + facts.high_mm[axis]);
  measure(mesh, origin, facts);
  return facts;
}

}  // namespace mezzotint
