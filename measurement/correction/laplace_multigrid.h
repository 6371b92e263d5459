#pragma once

#include <cstddef>
#include <vector>

#include "measurement/correction/laplace_system.h"

/// Inside of measurement/correction.

namespace mezzotint {

/// Solves a Laplace system by conjugate gradients, preconditioned by one V-cycle of multigrid: a few iterations for a
/// hole of any size, memory in proportion to it. Coarser grids have every second unknown of the finer one along each
/// axis, bilinear interpolation between them, and Galerkin's matrix, so that holes of any shape keep a symmetric,
/// positive definite matrix on all of them.
///
/// @param positions  of the unknowns in the field
/// @param columns    of the field
/// @throws MethodError where it does not converge to 1e-11 of the right side
/// Source   Trottenberg, Oosterlee, Schüller, "Multigrid", 2001, chapter 7.8 (multigrid as a preconditioner).
[[nodiscard]] Eigen::VectorXd solve_by_multigrid(const LaplaceSystem& system, const std::vector<std::size_t>& positions,
                                                 std::size_t columns);

}  // namespace mezzotint
