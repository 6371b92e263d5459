#pragma once

#include <cstdint>
#include <cstdlib>
#include <memory>

#include "forward/tracing/periodic_tile.h"

namespace mezzotint {

/// Heights of a tile for tracing: the samples, and the highest and lowest height of every block of 2^L × 2^L cells.
///
/// Frame    that of PeriodicTile. Samples have one more column and row than the tile, which repeat the first.
/// Layout   node (x, y) of level L stands at (((2^q + y₀) >> L) << (p − L)) + (x₀ >> L), where 2^p × 2^q is the
///          tile rounded up to powers of two and (x₀, y₀) a cell of the block: one array holds all levels, and a
///          place in it is found with shifts alone. `below` holds −(lowest height), so that rays from below
///          are traced as rays from above the relief turned over.
class HeightPyramid {
public:
  explicit HeightPyramid(const PeriodicTile& tile);

  std::int32_t columns = 0, rows = 0;
  std::int32_t log2_columns = 0, log2_rows = 0;  ///< p, q
  std::int32_t top_level = 0;                    ///< one block holds the tile
  float cell_y = 1.0F;
  float highest = 0.0F, lowest = 0.0F;
  float steepest = 0.0F;  ///< largest |∇z| of all facets: a steeper ray that has left the surface never meets it again

  [[nodiscard]] const float* samples() const { return samples_.get(); }
  [[nodiscard]] const float* above() const { return above_.get(); }
  [[nodiscard]] const float* below() const { return below_.get(); }
  [[nodiscard]] std::size_t node(std::int32_t level, std::int32_t x, std::int32_t y) const {
    const std::int32_t row = ((std::int32_t{1} << log2_rows) + (y << level)) >> level;
    return (static_cast<std::size_t>(row) << (log2_columns - level)) + static_cast<std::size_t>(x);
  }

private:
  struct Free {
    void operator()(float* memory) const { std::free(memory); }
  };
  // From calloc: gaps between levels cost addresses, not memory.
  using Array = std::unique_ptr<float[], Free>;
  static Array make_array(std::size_t size);
  void fill_samples(const PeriodicTile& tile);
  void fill_cells();
  void fill_level(std::int32_t level);

  Array samples_, above_, below_;
};

}  // namespace mezzotint
