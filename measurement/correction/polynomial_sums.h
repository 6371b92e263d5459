#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "measurement/correction/polynomial.h"
#include "measurement/correction/row_kernels.h"

/// Inside of measurement/correction.

namespace mezzotint {

/// Places from −1 at the first of a number of samples to 1 at the last; 0 where there is one alone.
[[nodiscard]] RowPlaces unit_places(std::size_t count);

/// A polynomial along one row.
class PolynomialRow {
public:
  PolynomialRow(const SurfacePolynomial& polynomial, const HeightField& field, std::size_t row);
  [[nodiscard]] RowPolynomial get() const { return {{coefficients_.data(), terms_}, places_}; }

private:
  std::size_t terms_;
  RowPlaces places_;
  std::array<double, highest_degree + 1> coefficients_{};
};

/// The normal equations of a polynomial through the samples of some rows. T_i T_k = (T_(i+k) + T_|i−k|)/2, so the
/// moments of single polynomials up to twice the degree are all that has to be summed over the samples: 2·degree + 1 a
/// sample, instead of all pairs of terms.
class PolynomialSums {
public:
  PolynomialSums(int degree, const HeightField& field);

  /// A row of samples; those that do not count are NaN.
  void add_row(std::size_t row, std::span<const float> heights_um);
  PolynomialSums& operator+=(const PolynomialSums& other);
  [[nodiscard]] double count() const { return weights_[0]; }
  /// @throws InvalidInput where the samples do not determine the polynomial
  [[nodiscard]] SurfacePolynomial solve() const;

private:
  [[nodiscard]] double moment(std::size_t i, std::size_t j) const { return weights_[j * moments_ + i]; }
  [[nodiscard]] double product(std::size_t i, std::size_t j, std::size_t k, std::size_t l) const;

  std::size_t terms_, moments_;
  RowPlaces along_x_, along_y_;
  std::vector<double> weights_, heights_;
};

}  // namespace mezzotint
