#pragma once

#include "measurement/comparison/refinement.h"

namespace mezzotint {

/// Covariance of the parameters of a fit, where the residual is correlated from sample to sample.
///
/// Least squares gives A⁻¹ B A⁻¹ with A = Σ_k J_k J_kᵀ and B = Σ_kl J_k c(k − l) J_lᵀ, c the autocovariance of the
/// residual; for a white residual B = c(0) A, and the textbook's c(0) A⁻¹ is left. c is estimated from the residual
/// under a Hann window of a few of its correlation lengths (without a window B would be 0, since the fit made
/// Σ J_k r_k vanish), and the double sum is one product of spectra. So c(0) A⁻¹ is divided by the share of
/// samples that are effectively independent, for each parameter apart: B weighs the residual's correlation with that
/// of the relief's slopes, which alternate, and a slow wave in the residual hardly moves the shift.
///
/// Source   the "sandwich" with correlated errors: Newey & West, Econometrica 55 (1987); in the plane: Conley,
///          J. Econometrics 92 (1999).
[[nodiscard]] FitVector standard_errors(const Matching& matching, const Fit& fit);

}  // namespace mezzotint
