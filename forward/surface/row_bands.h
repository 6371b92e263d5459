#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include <tbb/parallel_for.h>

/// Rows in bands of a fixed number, each the work of one thread, so that sums over
/// bands come out the same with any number of threads.

namespace mezzotint {

inline constexpr std::size_t band_rows = 32;

inline std::size_t band_count(std::size_t rows) { return (rows + band_rows - 1) / band_rows; }

/// visit(band, first row, row behind the last)
template <class Visit>
void for_each_band(std::size_t rows, const Visit& visit) {
  tbb::parallel_for(std::size_t{0}, band_count(rows),
                    [&](std::size_t band) { visit(band, band * band_rows, std::min(rows, (band + 1) * band_rows)); });
}

/// What sum(first row, row behind the last) gives for each band, added in their order by `+=`.
template <class Sums, class Sum>
Sums sum_of_bands(std::size_t rows, const Sums& zero, const Sum& sum) {
  std::vector<Sums> bands(band_count(rows), zero);
  for_each_band(rows, [&](std::size_t band, std::size_t first, std::size_t end) { bands[band] = sum(first, end); });
  Sums total = zero;
  for (const Sums& band : bands) total += band;
  return total;
}

}  // namespace mezzotint
