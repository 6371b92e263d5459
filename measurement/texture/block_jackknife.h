#pragma once

#include <cstddef>
#include <span>

namespace mezzotint {

/// Standard error of a statistic from its values with one block left out at a time. Blocks may hold different
/// numbers of samples (missing data); empty ones do not count. NaN for fewer than two blocks.
/// @param whole    the statistic of all samples
/// @param without  the statistic without block j
/// @param samples  in block j
/// Source   Busing, Meijer, van der Leeden, "Delete-m jackknife for unequal m", Statistics and Computing 9 (1999).
[[nodiscard]] double jackknife_standard_error(double whole, std::span<const double> without,
                                              std::span<const double> samples);

}  // namespace mezzotint
