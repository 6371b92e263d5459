#pragma once

#include <cstddef>
#include <span>

/// Inside of forward/process.

namespace mezzotint {

struct WeightedRow {
  const float* values = nullptr;
  float weight = 0.0F;
};

/// out = Σ weight · row, always summed in the same order: the same bits with every width of vector. 0 without a row.
void blend(std::span<const WeightedRow> rows, std::size_t count, float* out);

}  // namespace mezzotint
