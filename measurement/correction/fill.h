#pragma once

#include "forward/surface/height_field.h"

namespace mezzotint {

/// Missing samples replaced by the solution of Laplace's equation with the measured ones as boundary values (dx ≠ dy
/// respected; zero normal derivative at the ends of a patch, wrapped for a periodic one). Returns the field whole.
///
/// How      holes of up to 48 samples one by one, the larger ones together: by a sparse Cholesky factor, or by
///          multigrid where there is more to fill (residual 1e-11). Time and memory in proportion to what is missing.
/// @throws  InvalidInput when no sample was measured at all.
[[nodiscard]] HeightField fill_missing(HeightField field);

}  // namespace mezzotint
