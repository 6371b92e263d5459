#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fabrication/part/part_mesh.h"

namespace mezzotint {

/// The edges of a part with the triangles at each. Collapsed triangles (two corners are one vertex) have no part in it.
///
/// Two counting passes and a short sort for each vertex: 0.1 µs an edge, 10 bytes an edge and triangle.
class EdgeTable {
public:
  /// A triangle's side, seen from the vertex of the lower number.
  struct Side {
    std::uint32_t high;      ///< the other vertex
    std::uint32_t triangle;  ///< twice the triangle's number, plus 1 where it walks the edge from high to low
    [[nodiscard]] std::uint32_t number() const { return triangle >> 1U; }
    [[nodiscard]] bool walks_down() const { return (triangle & 1U) != 0; }
  };

  /// @throws InvalidInput for more than 2^30 triangles or a triangle that names no vertex
  explicit EdgeTable(const PartMesh& mesh);

  /// Calls `visit(low, sides)` once for each edge, in the order of its vertices; `sides` share the other vertex and are
  /// in the order of their triangles.
  template <class Visit>
  void for_each_edge(const Visit& visit) const {
    for (std::uint32_t low = 0; low + 1 < begins_.size(); ++low) {
      for (std::size_t begin = begins_[low], end = begin; begin < begins_[low + 1]; begin = end) {
        while (end < begins_[low + 1] && sides_[end].high == sides_[begin].high) ++end;
        visit(low, std::span<const Side>(&sides_[begin], end - begin));
      }
    }
  }

private:
  std::vector<std::uint32_t> begins_;
  std::vector<Side> sides_;
};

/// What triangles hold together through.
enum class Join { EdgesOfTwo, AnyEdge };

/// Which shell each triangle is in: pieces that hold together through edges, of exactly two triangles or of any number.
struct Shells {
  static constexpr std::uint32_t none = 0xFFFFFFFFU;  ///< of a collapsed triangle
  std::vector<std::uint32_t> of_triangle;
  std::uint32_t count = 0;
};
[[nodiscard]] Shells find_shells(const PartMesh& mesh, const EdgeTable& edges, Join join = Join::EdgesOfTwo);

}  // namespace mezzotint
