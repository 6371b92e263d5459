#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fabrication/slicing/coverage.h"

namespace mezzotint {

/// The largest whole number that is not above x. std::floor is a call where the processor's baseline has no
/// instruction.
[[nodiscard]] inline long floor_of(double x) {
  const auto whole = static_cast<long>(x);
  return whole - (static_cast<double>(whole) > x ? 1 : 0);
}

/// Rows of pixels into which signed areas are summed: each entry says by how much the coverage grows from the pixel
/// before to this one. The running sum along a row is the coverage, so what lies between two faces costs nothing.
///
/// Float cells: a row of 2560 pixels under some ten triangles each is then exact to about 1e-5, a hundredth of the
/// half gray level of 8 bits.
class AreaRows {
public:
  AreaRows(std::size_t columns, std::size_t rows);

  [[nodiscard]] std::size_t columns() const { return columns_; }
  [[nodiscard]] std::size_t rows() const { return rows_; }

  /// A face whose signed area `area` (as seen along x, positive where the row enters the material) lies in the pixel
  /// on average at `x`: the pixel is covered to the right of it, and all further pixels fully.
  /// Left of the first column counts from there on; right of the last one only closes the row. `row` is in the picture.
  void add(std::size_t row, long column, double area, double x) {
    if (column < 0 || column >= static_cast<long>(columns_)) return add_outside(row, column, area);
    const double right = static_cast<double>(column + 1) - x;
    add_split(row, static_cast<std::size_t>(column), area * right, area * (1.0 - right));
  }
  void add_outside(std::size_t row, long column, double area) { add_split(row, column < 0 ? 0 : columns_, area, 0.0); }
  /// The same with the two shares worked out: what the pixel itself gets, and what comes with the next.
  void add_split(std::size_t row, std::size_t column, double here, double beyond) {
    float* const cell = cells_.data() + row * stride_ + column;
    cell[0] += static_cast<float>(here);
    cell[1] += static_cast<float>(beyond);
    touched_[row * words_ + column / 64] |= std::uint64_t{1} << (column % 64);
    row_touched_[row] = 1;
  }

  /// Hands the rows on, coverage kept in [0, 1] (bodies that overlap are one), and empties them.
  /// @return how many rows did not close: the part has a hole there.
  std::size_t finish(const TakeCoverageRow& take_row);

private:
  bool finish_row(std::size_t row, std::vector<CoverageRun>& runs);

  std::size_t columns_, rows_, stride_, words_;
  std::vector<float> cells_;
  std::vector<std::uint64_t> touched_;  ///< a bit a pixel: this cell or the next one was added to
  std::vector<std::uint8_t> row_touched_;
};

}  // namespace mezzotint
