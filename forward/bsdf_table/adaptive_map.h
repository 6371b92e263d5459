#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "forward/optics/direction_map.h"

namespace mezzotint {

/// A direction map with bins joined to squares of 2ⁿ × 2ⁿ where it is smooth, and all that is needed to look it up
/// and to draw from it: one quadtree.
///
/// Frame    of its DirectionGrid; a square is constant over its bins ∩ disc, and never negative.
/// Cost     24 bytes a cell, 4/3 cells a square; a look-up or a draw walks down log₂(bins a side) levels.
/// Units    1/sr, in float, as in the file: what is read back is the same to the last bit.
class AdaptiveMap {
public:
  /// An empty map: no light in any direction.
  AdaptiveMap() = default;

  struct Square {
    float value = 0.0F;
    float standard_error = 0.0F;
    unsigned level = 0;  ///< log₂ of its side, in bins
  };
  /// Is the block of bins from (x, y) on, of side 2^level, one square, and of what value? Asked from the largest
  /// block down; at level 0 it must be.
  using Divide = std::function<std::optional<Square>(std::size_t x, std::size_t y, unsigned level)>;
  AdaptiveMap(const DirectionGrid& grid, const std::vector<double>& areas, const Divide& divide);

  [[nodiscard]] bool empty() const { return cells_.empty(); }
  [[nodiscard]] std::size_t square_count() const;
  /// |(x, y)| ≤ 1; of no light where the map is empty.
  [[nodiscard]] Square at(double x, double y) const;
  [[nodiscard]] Square at_bin(std::size_t column, std::size_t row) const;
  /// Σ value · area: the albedo.
  [[nodiscard]] double integral() const { return cells_.empty() ? 0.0 : cells_.front().integral; }

  /// A point of the disc with density value / integral, uniform within each square ∩ disc, by the two numbers of
  /// [0, 1) taken down the tree; near numbers give near points. @pre integral() > 0
  [[nodiscard]] Eigen::Vector2d sample(double u1, double u2) const;

  /// The largest level: the root's.
  [[nodiscard]] static unsigned levels_of(const DirectionGrid& grid);

private:
  struct Cell {
    double integral = 0.0;
    std::uint32_t first_child = 0;  // 0: a square; the children lie in the order (x, y), (x+, y), (x, y+), (x+, y+)
    float value = 0.0F;
    float standard_error = 0.0F;
  };
  void fill(std::size_t cell, std::size_t x, std::size_t y, unsigned level, const std::vector<double>& areas,
            const Divide& divide);
  [[nodiscard]] Eigen::Vector2d sample_block(std::size_t x, std::size_t y, unsigned level, double u1, double u2) const;

  DirectionGrid grid_;
  std::vector<Cell> cells_;
};

/// Joins bins as long as the map stays within `tolerance` of what it was, in relative_l2 without noise.
///
/// How      A block is joined where Σ a (f − mean)², over its bins and by two independent halves so that noise does not
///          count, is at most tolerance² times the mean of Σ_block a f² and of G · (area of the block)/π, G = Σ a f²
///          over the disc. The shares sum to tolerance² G, so the bound holds for the whole map. The integral is kept:
///          exactly by joining; bins that noise made negative become 0, and the others are scaled down for it.
struct JoinedMap {
  AdaptiveMap map;
  double difference = 0.0;     ///< relative_l2 to the map that was given, without noise
  double clipped_share = 0.0;  ///< of the integral, that was negative
};
/// @throws InvalidInput for maps that do not fit the grid.
[[nodiscard]] JoinedMap join_smooth_bins(const DirectionGrid& grid, const MapEstimate& map, double tolerance);

}  // namespace mezzotint
