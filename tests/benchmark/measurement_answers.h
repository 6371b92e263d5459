#pragma once

#include <cstddef>

namespace mezzotint::benchmark {

/// Prints how far our answers and Gwyddion's lie apart on the same scan of size² samples, by Gwyddion's definitions
/// where they differ from ours; and both fillings beside an exact one (a sparse Cholesky factor of the same equations).
void print_answers(std::size_t size);

}  // namespace mezzotint::benchmark
