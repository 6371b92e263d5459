#pragma once

#include <string>

#include "forward/surface/height_field.h"

namespace mezzotint {

/// Missing samples replaced by the solution of Laplace's equation with the measured ones as boundary values (dx ≠ dy
/// respected; zero normal derivative at the ends of a patch, wrapped for a periodic one). Returns the field whole.
///
/// How      holes of up to 48 samples one by one, the larger ones together: by a sparse Cholesky factor, or by
///          multigrid where there is more to fill (residual 1e-11). Time and memory in proportion to what is missing.
/// @throws  InvalidInput when no sample was measured at all.
[[nodiscard]] HeightField fill_missing(HeightField field);

/// Where what was filled is smoother than what was measured, so that Sdq of the whole is too small by 1 % or more: by
/// how much, in words; else empty. It happens to holes that are wider than the features of the surface.
///
/// How      mean square gradients of pairs of neighbours that were both measured, and of all.
/// @param before  with the samples missing that `filled` has
[[nodiscard]] std::string fill_warning(const HeightField& before, const HeightField& filled);

}  // namespace mezzotint
