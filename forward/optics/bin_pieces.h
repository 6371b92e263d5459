#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "forward/optics/direction_map.h"

/// Inside of forward/optics: the pixels of a direction map, cut by the unit disc.

namespace mezzotint {

/// A rectangle of the projection plane, mirrored into its first quadrant (0 ≤ x0 < x1, 0 ≤ y0 < y1);
/// the signs lead back. There the disc has one arc, and a rectangle meets it in one way only.
struct BinPiece {
  double x0, x1, y0, y1;
  double sign_x, sign_y;
};

/// A bin, cut where it straddles an axis: up to four pieces.
struct BinPieces {
  std::array<BinPiece, 4> piece;
  std::size_t count = 0;

  [[nodiscard]] const BinPiece* begin() const { return piece.data(); }
  [[nodiscard]] const BinPiece* end() const { return piece.data() + count; }
};
[[nodiscard]] BinPieces pieces_of_bin(const DirectionGrid& grid, std::size_t column, std::size_t row);

[[nodiscard]] inline bool is_inside(const BinPiece& piece) { return piece.x1 * piece.x1 + piece.y1 * piece.y1 <= 1.0; }
[[nodiscard]] inline bool is_outside(const BinPiece& piece) { return piece.x0 * piece.x0 + piece.y0 * piece.y0 >= 1.0; }

/// Exact area of piece ∩ disc.
[[nodiscard]] double area_in_disc(const BinPiece& piece);

/// √(1 − x²) without loss of digits near 1; 0 beyond.
[[nodiscard]] inline double other_leg(double x) { return std::sqrt(std::max(0.0, (1.0 - x) * (1.0 + x))); }

/// A part of pixel ∩ disc with smooth coordinates (s, t) in [0, 1]²: s from row to row, t along a row, from
/// the rim inward where the row ends there. Toward the rim a row runs as t², because a function of
/// direction has a root, √(1 − r²), there, which is smooth in t. Rows run along the axis that the rim
/// crosses more steeply.
struct BinPatch {
  double row_begin, row_end;
  double from, to;  ///< along a row; `to` means nothing where it ends at the rim
  bool ends_at_rim;
  bool rows_along_x;
  double sign_x, sign_y;

  struct Point {
    double x, y;
    double density;  ///< area of the plane an area of (s, t)
  };
  [[nodiscard]] Point at(double s, double t) const {
    const double row = row_begin + (row_end - row_begin) * s;
    const double length = ends_at_rim ? std::max(0.0, other_leg(row) - from) : to - from;
    const double along = from + length * (ends_at_rim ? 1.0 - t * t : t);
    const double density = (row_end - row_begin) * length * (ends_at_rim ? 2.0 * t : 1.0);
    return {sign_x * (rows_along_x ? along : row), sign_y * (rows_along_x ? row : along), density};
  }
};

/// All of pixel ∩ disc of a bin: none where it lies outside, two a piece where the rim leaves it sideways.
struct BinPatches {
  std::array<BinPatch, 8> patch;
  std::size_t count = 0;

  [[nodiscard]] const BinPatch* begin() const { return patch.data(); }
  [[nodiscard]] const BinPatch* end() const { return patch.data() + count; }
};
[[nodiscard]] BinPatches patches_of_bin(const DirectionGrid& grid, std::size_t column, std::size_t row);

}  // namespace mezzotint
