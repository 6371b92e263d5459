#include "measurement/correction/polynomial_sums.h"

#include <algorithm>
#include <string>

#include <Eigen/Dense>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

constexpr std::size_t most_moments = 2 * highest_degree + 1;

// T_0(x) … T_(count−1)(x).
std::array<double, most_moments> chebyshev(double x, std::size_t count) {
  std::array<double, most_moments> t{1.0, x};
  for (std::size_t k = 2; k < count; ++k) t[k] = 2.0 * x * t[k - 1] - t[k - 2];
  return t;
}

double place(RowPlaces places, std::size_t index) { return places.first + places.step * static_cast<double>(index); }

std::size_t distance(std::size_t a, std::size_t b) { return a > b ? a - b : b - a; }

}  // namespace

RowPlaces unit_places(std::size_t count) {
  return count > 1 ? RowPlaces{-1.0, 2.0 / static_cast<double>(count - 1)} : RowPlaces{};
}

// Along a row the polynomial is Σ_i a_i T_i(x), with a_i = Σ_j c_ij T_j(y).
PolynomialRow::PolynomialRow(const SurfacePolynomial& polynomial, const HeightField& field, std::size_t row)
    : terms_(static_cast<std::size_t>(polynomial.degree) + 1), places_(unit_places(field.columns())) {
  const auto t = chebyshev(place(unit_places(field.rows()), row), terms_);
  std::size_t term = 0;
  for (std::size_t j = 0; j < terms_; ++j)
    for (std::size_t i = 0; i + j < terms_; ++i) coefficients_[i] += polynomial.coefficients_um[term++] * t[j];
}

PolynomialSums::PolynomialSums(int degree, const HeightField& field)
    : terms_(static_cast<std::size_t>(degree) + 1),
      moments_(2 * terms_ - 1),
      along_x_(unit_places(field.columns())),
      along_y_(unit_places(field.rows())),
      weights_(moments_ * moments_, 0.0),
      heights_(terms_ * terms_, 0.0) {}

void PolynomialSums::add_row(std::size_t row, std::span<const float> heights_um) {
  std::array<double, most_moments> weight{};
  std::array<double, highest_degree + 1> height{};
  chebyshev_sums(heights_um, along_x_, terms_ - 1, weight.data(), height.data());
  const auto t = chebyshev(place(along_y_, row), moments_);
  for (std::size_t j = 0; j < moments_; ++j)
    for (std::size_t i = 0; i < moments_; ++i) weights_[j * moments_ + i] += t[j] * weight[i];
  for (std::size_t j = 0; j < terms_; ++j)
    for (std::size_t i = 0; i < terms_; ++i) heights_[j * terms_ + i] += t[j] * height[i];
}

PolynomialSums& PolynomialSums::operator+=(const PolynomialSums& other) {
  std::ranges::transform(weights_, other.weights_, weights_.begin(), std::plus<>());
  std::ranges::transform(heights_, other.heights_, heights_.begin(), std::plus<>());
  return *this;
}

// Σ T_i(x) T_j(y) T_k(x) T_l(y).
double PolynomialSums::product(std::size_t i, std::size_t j, std::size_t k, std::size_t l) const {
  const std::size_t high_x = i + k, low_x = distance(i, k), high_y = j + l, low_y = distance(j, l);
  return 0.25 * (moment(high_x, high_y) + moment(low_x, high_y) + moment(high_x, low_y) + moment(low_x, low_y));
}

SurfacePolynomial PolynomialSums::solve() const {
  struct Term {
    std::size_t i, j;
  };
  std::vector<Term> terms;
  for (std::size_t j = 0; j < terms_; ++j)
    for (std::size_t i = 0; i + j < terms_; ++i) terms.push_back({i, j});
  const auto unknowns = static_cast<Eigen::Index>(terms.size());
  const double scale = 1.0 / std::max(1.0, count());
  Eigen::MatrixXd matrix(unknowns, unknowns);
  Eigen::VectorXd right(unknowns);
  for (Eigen::Index a = 0; a < unknowns; ++a) {
    const auto [i, j] = terms[static_cast<std::size_t>(a)];
    right[a] = scale * heights_[j * terms_ + i];
    for (Eigen::Index b = 0; b < unknowns; ++b) {
      const auto [k, l] = terms[static_cast<std::size_t>(b)];
      matrix(a, b) = scale * product(i, j, k, l);
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(matrix, Eigen::EigenvaluesOnly);
  // Samples that leave a term open give an eigenvalue of 0, up to rounding.
  constexpr double rounding = 1e-13;
  require(count() >= static_cast<double>(unknowns) &&
              spectrum.eigenvalues().minCoeff() > rounding * spectrum.eigenvalues().maxCoeff(),
          "the measured samples do not determine a polynomial of degree " + std::to_string(terms_ - 1) +
              "; use a lower degree");
  const Eigen::VectorXd solution = matrix.ldlt().solve(right);
  return {static_cast<int>(terms_) - 1, {solution.begin(), solution.end()}};
}

}  // namespace mezzotint
