#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace mezzotint {

/// One number for all places that are exactly the same: how the corners of triangles become vertices.
///
/// Places are compared bit by bit, −0 being 0; NaN is not for here. The table is open-addressed: the 6 million
/// corners of a relief plate cost a look each into a few bytes, and no allocation.
class VertexWelder {
public:
  using Place = std::array<double, 3>;

  /// `expected` vertices fit without a new table.
  explicit VertexWelder(std::size_t expected = 0);
  /// The number of a place: the order in which places were first seen. The second is whether it is new.
  struct Number {
    std::uint32_t value;
    bool is_new;
  };
  [[nodiscard]] Number number(Place place);
  /// Fetches what `number` of this place will look at: for the places of some dozen calls ahead.
  void prefetch(Place place) const;
  [[nodiscard]] const std::vector<Place>& vertices() const { return vertices_; }
  [[nodiscard]] std::vector<Place> take_vertices() { return std::move(vertices_); }

private:
  struct Slot {
    std::uint32_t number_plus_one = 0;  ///< 0: empty
    std::uint32_t hash = 0;
  };
  void grow();

  std::vector<Place> vertices_;
  std::vector<Slot> slots_;
};

}  // namespace mezzotint
