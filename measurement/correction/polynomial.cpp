#include "measurement/correction/polynomial.h"

#include <cmath>
#include <limits>
#include <string>

#include "forward/base/error.h"
#include "forward/surface/row_bands.h"
#include "measurement/correction/plane_rows.h"
#include "measurement/correction/polynomial_sums.h"

namespace mezzotint {

namespace {

void require_degree(int degree) {
  require(degree >= 0 && degree <= highest_degree,
          "a polynomial has a degree from 0 to 12, not " + std::to_string(degree));
}

}  // namespace

SurfacePolynomial fit_polynomial(const HeightField& field, int degree, std::span<const std::uint8_t> use) {
  require_degree(degree);
  require(use.empty() || use.size() == field.grid().size(), "a mask needs one value for every sample");
  const PolynomialSums none(degree, field);
  const PolynomialSums sums = sum_of_bands(field.rows(), none, [&](std::size_t first, std::size_t end) {
    PolynomialSums band = none;
    std::vector<float> used_um(use.empty() ? 0 : field.columns());
    for (std::size_t row = first; row < end; ++row) {
      const auto line = row_of(field, row);
      for (std::size_t c = 0; c < used_um.size(); ++c)
        used_um[c] = use[row * line.size() + c] != 0 ? line[c] : std::numeric_limits<float>::quiet_NaN();
      band.add_row(row, use.empty() ? line : used_um);
    }
    return band;
  });
  return sums.solve();
}

HeightField subtract_polynomial(HeightField field, const SurfacePolynomial& polynomial) {
  require_degree(polynomial.degree);
  const auto terms = static_cast<std::size_t>(polynomial.degree) + 1;
  require(polynomial.coefficients_um.size() == terms * (terms + 1) / 2,
          "a polynomial has a coefficient for every term");
  for_each_band(field.rows(), [&](std::size_t, std::size_t first, std::size_t end) {
    for (std::size_t row = first; row < end; ++row) {
      const auto line = row_of(field, row);
      subtract_row_polynomial(line, PolynomialRow(polynomial, field, row).get(), line);
    }
  });
  field.set_frame(polynomial.degree == 0 ? field.continuation() : Continuation::Mirrored,
                  field.datum() + Length::from_um(polynomial.coefficients_um[0]));
  return field;
}

}  // namespace mezzotint
