#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// Inside of measurement/correction: what is done to a row of samples, with the vectors that the machine has. All sums
/// are in double and over the measured samples alone; their order depends on the width of the vectors, on nothing else.

namespace mezzotint {

/// Places of a row's samples along it: first + step·index.
struct RowPlaces {
  double first = 0.0, step = 0.0;
};

struct RowMoments {
  double count = 0.0, x = 0.0, xx = 0.0, z = 0.0, xz = 0.0;
};
/// Moments of place and of height above a reference.
[[nodiscard]] RowMoments row_moments(std::span<const float> heights_um, RowPlaces places, double reference_um);

/// A straight line over a row: at the first sample, and what it rises by from one to the next.
struct RowLine {
  double first_um = 0.0, rise_um = 0.0;
};
void subtract_line(std::span<float> heights_um, RowLine line);
/// Σ of squared heights above the line.
[[nodiscard]] double squares_above_line(std::span<const float> heights_um, RowLine line);
/// Columns of samples that lie further than `limit_um` from the line, in ascending order.
void find_beyond(std::span<const float> heights_um, RowLine line, double limit_um, std::vector<std::uint32_t>& found);

/// Σ_i c_i T_i(x) with Chebyshev's polynomials, along a row; x of the samples by `places`.
struct RowPolynomial {
  std::span<const double> coefficients_um;  ///< one at least
  RowPlaces places;
};
/// out = in minus the polynomial, rounded to float; both may be the same.
void subtract_row_polynomial(std::span<const float> in_um, const RowPolynomial& polynomial, std::span<float> out_um);

/// Σ T_k(x) over the measured samples for k < 2·degree + 1, and Σ T_k(x)·z for k < degree + 1; degree 12 at most.
void chebyshev_sums(std::span<const float> heights_um, RowPlaces places, std::size_t degree, double* weights,
                    double* heights);

}  // namespace mezzotint
