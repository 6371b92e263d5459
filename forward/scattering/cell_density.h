#pragma once

#include <cstdint>
#include <vector>

#include "forward/scattering/sample_strata.h"

namespace mezzotint {

/// Points of the macro area, and what each stands for.
struct SurfacePoints {
  explicit SurfacePoints(std::size_t capacity)
      : cell_x(capacity), cell_y(capacity), x(capacity), y(capacity), weight(capacity) {}
  std::vector<std::int32_t> cell_x, cell_y;
  std::vector<float> x, y;    ///< in the cell, [0, 1)
  std::vector<float> weight;  ///< uniform density ÷ the density that drew the point
};

/// A density over the macro area that is constant on every cell of a tile, to draw points from.
///
/// Order    points come along a Morton curve of blocks of 8 × 8 cells, one in each of as many strata of equal
///          probability, so that a cell gets the points that it is worth, to one.
/// Bias     none: a weight is made of the same stored sums that a point is drawn by.
/// Missing  a cell of density 0 gets no points; what happens there must not matter.
/// Memory   4 bytes a cell.
class CellDensity {
public:
  /// @param importance  the density of each cell up to a factor, row after row; not all 0.
  CellDensity(std::uint32_t columns, std::uint32_t rows, const std::vector<float>& importance);

  /// The points of strata first … first + count − 1.
  void points(const SampleStrata& strata, std::uint64_t first, std::size_t count, SurfacePoints& points) const;

private:
  struct Block {
    std::uint32_t column, row;  ///< of its first cell
    double before;              ///< the density of all blocks before it
  };
  [[nodiscard]] std::size_t block_at(double place, std::size_t from) const;
  void place(const Block& block, double place, double aside, std::size_t at, SurfacePoints& points) const;

  std::vector<Block> blocks_;  ///< and one behind the last
  std::vector<float> sums_;    ///< of a block's cells in its order, up to and with each
  double mean_ = 0.0;          ///< density of a cell
};

}  // namespace mezzotint
