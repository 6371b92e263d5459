#include "forward/optics/bin_pieces.h"

namespace mezzotint {

namespace {

// A range of one axis, mirrored to the positive side; two of them where it straddles 0.
struct Range {
  double from, to, sign;
};
struct Ranges {
  std::array<Range, 2> range;
  std::size_t count;
};

// Edges are whole numbers over the number of bins, so that both sides of an axis mirror to the last bit.
Ranges ranges_of(std::size_t index, std::size_t bins) {
  const double count = static_cast<double>(bins);
  const double from = (2.0 * static_cast<double>(index) - count) / count;
  const double to = (2.0 * static_cast<double>(index) + 2.0 - count) / count;
  if (from >= 0.0) return {{{{from, to, 1.0}, {}}}, 1};
  if (to <= 0.0) return {{{{-to, -from, -1.0}, {}}}, 1};
  return {{{{0.0, -from, -1.0}, {0.0, to, 1.0}}}, 2};
}

void add_patches(const BinPiece& piece, BinPatches& patches) {
  if (is_outside(piece)) return;
  const bool along_x = piece.x0 + piece.x1 >= piece.y0 + piece.y1;
  const double from = along_x ? piece.x0 : piece.y0, to = along_x ? piece.x1 : piece.y1;
  const double begin = along_x ? piece.y0 : piece.x0, end = along_x ? piece.y1 : piece.x1;
  const double last = is_inside(piece) ? end : std::min(end, other_leg(from));
  const double whole_until = is_inside(piece) ? end : std::clamp(other_leg(to), begin, last);
  const auto add = [&](double row_begin, double row_end, bool ends_at_rim) {
    if (row_begin >= row_end) return;
    patches.patch[patches.count++] = {row_begin, row_end, from, to, ends_at_rim, along_x, piece.sign_x, piece.sign_y};
  };
  add(begin, whole_until, false);
  add(whole_until, last, true);
}

}  // namespace

BinPatches patches_of_bin(const DirectionGrid& grid, std::size_t column, std::size_t row) {
  BinPatches patches;
  for (const BinPiece& piece : pieces_of_bin(grid, column, row)) add_patches(piece, patches);
  return patches;
}

BinPieces pieces_of_bin(const DirectionGrid& grid, std::size_t column, std::size_t row) {
  const Ranges across = ranges_of(column, grid.width);
  const Ranges down = ranges_of(row, grid.height);
  BinPieces pieces;
  for (std::size_t j = 0; j < down.count; ++j) {
    for (std::size_t i = 0; i < across.count; ++i) {
      const Range& x = across.range[i];
      const Range& y = down.range[j];
      pieces.piece[pieces.count++] = {x.from, x.to, y.from, y.to, x.sign, y.sign};
    }
  }
  return pieces;
}

double area_in_disc(const BinPiece& piece) {
  const double height = piece.y1 - piece.y0;
  if (is_outside(piece)) return 0.0;
  if (is_inside(piece)) return (piece.x1 - piece.x0) * height;
  // From left to right: columns of full height, then those that the arc ends, then nothing.
  const double meets_top = other_leg(piece.y1), meets_bottom = other_leg(piece.y0);
  const double a = std::max(meets_top, piece.x0), b = std::min(meets_bottom, piece.x1);
  const double y_a = a == meets_top ? piece.y1 : other_leg(a);
  const double y_b = b == meets_bottom ? piece.y0 : other_leg(b);
  // Under the chord, then the segment between chord and arc: differences of neighbours only, no loss of
  // digits however small the bin.
  const double under_chord = 0.5 * (b - a) * ((y_a - piece.y0) + (y_b - piece.y0));
  const double arc = 2.0 * std::asin(0.5 * std::hypot(b - a, y_a - y_b));
  return (a - piece.x0) * height + under_chord + 0.5 * (arc - std::sin(arc));
}

}  // namespace mezzotint
