#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "forward/surface/height_field.h"

namespace mezzotint {

/// A polynomial in x and y of a total degree: Σ c_ij T_i(x) T_j(y), i + j ≤ degree, T Chebyshev's polynomials.
///
/// Frame    x and y from −1 at the first sample of a field to 1 at its last.
/// Shape    coefficients_um in the order (i, j) = (0,0), (1,0), …, (degree,0), (0,1), …, (0,degree).
struct SurfacePolynomial {
  int degree = 0;
  std::vector<double> coefficients_um;
};

inline constexpr int highest_degree = 12;

/// The polynomial of least squares through the measured samples.
/// @param use  samples that count (not 0), one a sample; empty: all.
/// @throws InvalidInput for a degree outside 0 … 12, or where the samples do not determine it.
[[nodiscard]] SurfacePolynomial fit_polynomial(const HeightField& field, int degree,
                                               std::span<const std::uint8_t> use = {});

/// The field with a polynomial subtracted (in double). Only a constant leaves a periodic field periodic. The constant
/// goes to the datum.
[[nodiscard]] HeightField subtract_polynomial(HeightField field, const SurfacePolynomial& polynomial);

}  // namespace mezzotint
