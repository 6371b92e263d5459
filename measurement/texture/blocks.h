#pragma once

#include <cmath>
#include <cstddef>

#include "forward/surface/height_field.h"

/// Inside of measurement/texture: the 4 × 4 blocks that standard errors come from.

namespace mezzotint {

inline constexpr std::size_t blocks_a_side = 4;
inline constexpr std::size_t block_count = blocks_a_side * blocks_a_side;

/// Block of the sample (or cell) `index` of `count` along one side.
inline std::size_t block_along(std::size_t index, std::size_t count) { return blocks_a_side * index / count; }

/// visit(block column, first index, index behind the last) for each of the stretches that `count` samples along one
/// side (or cells between them) fall into.
template <class Visit>
void for_each_block_along(std::size_t count, const Visit& visit) {
  for (std::size_t block = 0; block < blocks_a_side; ++block) {
    const auto begin = [count](std::size_t k) { return (k * count + blocks_a_side - 1) / blocks_a_side; };
    if (begin(block) < begin(block + 1)) visit(block, begin(block), begin(block + 1));
  }
}

/// visit(block, height in µm) for every measured sample.
template <class Visit>
void for_each_in_blocks(const HeightField& field, const Visit& visit) {
  for (std::size_t row = 0; row < field.rows(); ++row) {
    const std::size_t block_row = blocks_a_side * block_along(row, field.rows());
    for (std::size_t column = 0; column < field.columns(); ++column) {
      const float z = field.at(column, row);
      if (!std::isnan(z)) visit(block_row + block_along(column, field.columns()), static_cast<double>(z));
    }
  }
}

}  // namespace mezzotint
