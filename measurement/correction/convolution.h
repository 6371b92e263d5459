#pragma once

#include <cstddef>

/// Inside of measurement/correction.

namespace mezzotint {

/// out(r, c) = Σ_k weights[k] · in(r + k, c), k = 0 … taps − 1: along the columns of an array, with the vectors that
/// the machine has.
///
/// Shape  `in` has rows + taps − 1 rows, `out` has `rows`; both have `columns` values a row, row after row.
void convolve_columns(const double* in, std::size_t rows, std::size_t columns, const double* weights, std::size_t taps,
                      double* out);

}  // namespace mezzotint
