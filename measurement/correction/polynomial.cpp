#include "measurement/correction/polynomial.h"

#include <array>
#include <cmath>
#include <string>

#include <Eigen/Dense>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

constexpr std::size_t most_moments = 2 * highest_degree + 1;

// T_0 … T_(count−1) at every sample along an axis: values[k·length + sample].
std::vector<double> chebyshev_table(std::size_t count, std::size_t length) {
  std::vector<double> values(count * length, 1.0);
  for (std::size_t i = 0; i < length; ++i) {
    const double x = length > 1 ? 2.0 * static_cast<double>(i) / static_cast<double>(length - 1) - 1.0 : 0.0;
    if (count > 1) values[length + i] = x;
    for (std::size_t k = 2; k < count; ++k)
      values[k * length + i] = 2.0 * x * values[(k - 1) * length + i] - values[(k - 2) * length + i];
  }
  return values;
}

/// The normal equations. T_i T_k = (T_(i+k) + T_|i−k|)/2, so the moments of single polynomials up to twice the degree
/// are all that has to be summed over the samples: 2·degree + 1 a sample, instead of all pairs of terms.
class NormalEquations {
public:
  NormalEquations(const HeightField& field, int degree)
      : terms_(static_cast<std::size_t>(degree) + 1),
        moments_(2 * terms_ - 1),
        columns_(field.columns()),
        along_x_(chebyshev_table(moments_, field.columns())),
        along_y_(chebyshev_table(moments_, field.rows())),
        rows_(field.rows()),
        weights_(moments_ * moments_, 0.0),
        heights_(terms_ * terms_, 0.0) {}

  // A row of samples; those that do not count are NaN.
  void add_row(std::size_t row, std::span<const float> heights_um) {
    std::array<double, most_moments> weight{};
    std::array<double, highest_degree + 1> height{};
    for (std::size_t k = 0; k < moments_; ++k) {
      const double* t = along_x_.data() + k * columns_;
      double sum = 0.0, sum_z = 0.0;
      for (std::size_t c = 0; c < columns_; ++c) {
        const double z = static_cast<double>(heights_um[c]);
        const bool counts = !std::isnan(z);
        sum += counts ? t[c] : 0.0;
        sum_z += counts ? t[c] * z : 0.0;
      }
      weight[k] = sum;
      if (k < terms_) height[k] = sum_z;
    }
    for (std::size_t j = 0; j < moments_; ++j) {
      const double t = along_y_[j * rows_ + row];
      for (std::size_t i = 0; i < moments_; ++i) weights_[j * moments_ + i] += t * weight[i];
      if (j >= terms_) continue;
      for (std::size_t i = 0; i < terms_; ++i) heights_[j * terms_ + i] += t * height[i];
    }
    count_ += weight[0];
  }

  [[nodiscard]] std::vector<double> solve() const {
    struct Term {
      std::size_t i, j;
    };
    std::vector<Term> terms;
    for (std::size_t j = 0; j < terms_; ++j)
      for (std::size_t i = 0; i + j < terms_; ++i) terms.push_back({i, j});
    const auto count = static_cast<Eigen::Index>(terms.size());
    Eigen::MatrixXd matrix(count, count);
    Eigen::VectorXd right(count);
    for (Eigen::Index a = 0; a < count; ++a) {
      const Term s = terms[static_cast<std::size_t>(a)];
      right[a] = heights_[s.j * terms_ + s.i] / std::max(1.0, count_);
      for (Eigen::Index b = 0; b < count; ++b) {
        const Term t = terms[static_cast<std::size_t>(b)];
        const std::size_t high_i = s.i + t.i, low_i = s.i > t.i ? s.i - t.i : t.i - s.i;
        const std::size_t high_j = s.j + t.j, low_j = s.j > t.j ? s.j - t.j : t.j - s.j;
        matrix(a, b) = 0.25 *
                       (moment(high_i, high_j) + moment(low_i, high_j) + moment(high_i, low_j) + moment(low_i, low_j)) /
                       std::max(1.0, count_);
      }
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(matrix, Eigen::EigenvaluesOnly);
    // Samples that leave a term open give an eigenvalue of 0, up to rounding.
    constexpr double rounding = 1e-13;
    require(count_ >= static_cast<double>(count) &&
                spectrum.eigenvalues().minCoeff() > rounding * spectrum.eigenvalues().maxCoeff(),
            "the measured samples do not determine a polynomial of degree " + std::to_string(terms_ - 1) +
                "; use a lower degree");
    const Eigen::VectorXd solution = matrix.ldlt().solve(right);
    return {solution.begin(), solution.end()};
  }

private:
  [[nodiscard]] double moment(std::size_t i, std::size_t j) const { return weights_[j * moments_ + i]; }

  std::size_t terms_, moments_, columns_;
  std::vector<double> along_x_, along_y_;
  std::size_t rows_;
  std::vector<double> weights_, heights_;
  double count_ = 0.0;
};

void require_degree(int degree) {
  require(degree >= 0 && degree <= highest_degree,
          "a polynomial has a degree from 0 to 12, not " + std::to_string(degree));
}

}  // namespace

SurfacePolynomial fit_polynomial(const HeightField& field, int degree, std::span<const std::uint8_t> use) {
  require_degree(degree);
  require(use.empty() || use.size() == field.grid().size(), "a mask needs one value for every sample");
  NormalEquations equations(field, degree);
  std::vector<float> row_um(field.columns());
  for (std::size_t row = 0; row < field.rows(); ++row) {
    const auto line = field.heights_um().subspan(row * field.columns(), field.columns());
    if (use.empty()) {
      equations.add_row(row, line);
      continue;
    }
    for (std::size_t c = 0; c < row_um.size(); ++c)
      row_um[c] = use[row * field.columns() + c] != 0 ? line[c] : std::nanf("");
    equations.add_row(row, row_um);
  }
  return {degree, equations.solve()};
}

HeightField subtract_polynomial(const HeightField& field, const SurfacePolynomial& polynomial) {
  require_degree(polynomial.degree);
  const auto terms = static_cast<std::size_t>(polynomial.degree) + 1;
  require(polynomial.coefficients_um.size() == terms * (terms + 1) / 2,
          "a polynomial has a coefficient for every term");
  const std::vector<double> along_x = chebyshev_table(terms, field.columns());
  const std::vector<double> along_y = chebyshev_table(terms, field.rows());
  std::vector<float> heights_um(field.grid().size());
  std::vector<double> line(field.columns());
  for (std::size_t row = 0; row < field.rows(); ++row) {
    // Along a row the polynomial is Σ_i a_i T_i(x), with a_i = Σ_j c_ij T_j(y).
    std::array<double, highest_degree + 1> a{};
    std::size_t term = 0;
    for (std::size_t j = 0; j < terms; ++j)
      for (std::size_t i = 0; i + j < terms; ++i)
        a[i] += polynomial.coefficients_um[term++] * along_y[j * field.rows() + row];
    std::fill(line.begin(), line.end(), a[0]);
    for (std::size_t i = 1; i < terms; ++i) {
      const double* t = along_x.data() + i * field.columns();
      for (std::size_t c = 0; c < line.size(); ++c) line[c] += a[i] * t[c];
    }
    for (std::size_t c = 0; c < line.size(); ++c)
      heights_um[row * field.columns() + c] = static_cast<float>(static_cast<double>(field.at(c, row)) - line[c]);
  }
  const Continuation ends = polynomial.degree == 0 ? field.continuation() : Continuation::Mirrored;
  return HeightField(field.grid(), ends, std::move(heights_um),
                     field.datum() + Length::from_um(polynomial.coefficients_um[0]));
}

}  // namespace mezzotint
