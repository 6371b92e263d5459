#include "inverse/design/expected_covariance.h"

#include <algorithm>
#include <array>

#include <Eigen/Eigenvalues>

#include "forward/base/error.h"
#include "forward/pattern/octave_sum.h"
#include "inverse/target/covariance_matrix.h"

namespace mezzotint {

namespace {

constexpr std::size_t reach = 3;

// Coefficients of f(+1) − f(−1), f(+2) − f(−2), f(+3) − f(−3). Source: Fornberg, Math. Comp. 51 (1988).
constexpr std::array<double, reach> weights = {45.0 / 60.0, -9.0 / 60.0, 1.0 / 60.0};

SlopeCovariance covariance_of_matrix(const Eigen::Matrix2d& m) { return {m(0, 0), m(1, 1), 0.5 * (m(0, 1) + m(1, 0))}; }

Eigen::Matrix2d power(const Eigen::Matrix2d& matrix, double exponent) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(matrix);
  const Eigen::Vector2d values = solver.eigenvalues().cwiseMax(1e-14).array().pow(exponent);
  return solver.eigenvectors() * values.asDiagonal() * solver.eigenvectors().transpose();
}

double difference(const float* at, std::size_t stride) {
  double sum = 0.0;
  for (std::size_t k = 0; k < reach; ++k) {
    const auto step = static_cast<std::ptrdiff_t>((k + 1) * stride);
    sum += weights[k] * (static_cast<double>(at[step]) - static_cast<double>(at[-step]));
  }
  return sum;
}

// Noise of cells of six samples or more: its waves are some eight samples long, whose slopes differences have to 0.2 %.
constexpr double least_samples = 6.0;

template <typename Kind>
bool is_smooth(const Kind& kind, Length pitch) {
  if constexpr (std::is_same_v<Kind, Noise> || std::is_same_v<Kind, FractionalBrownianMotion>) {
    return kind.scale / octave_sum(kind).octaves.back().frequency >= least_samples * pitch;
  }
  return false;
}
bool are_smooth(const std::vector<PatternPart>& parts, Length pitch) {
  return std::ranges::all_of(parts, [pitch](const PatternPart& part) {
    return std::visit([pitch](const auto& kind) { return is_smooth(kind, pitch); }, part.pattern);
  });
}
bool is_smooth(const PatternSum& sum, Length pitch) { return are_smooth(sum.parts, pitch); }
bool is_smooth(const TurnedPattern& turned, Length pitch) { return are_smooth(turned.parts, pitch); }

}  // namespace

SlopeCovariance point_slope_covariance(const HeightField& heights) {
  require(heights.columns() >= 16 && heights.rows() >= 16, "slopes at points need 16 samples a side");
  const double per_x = 1.0 / heights.grid().pitch_x.um(), per_y = 1.0 / heights.grid().pitch_y.um();
  double x = 0.0, y = 0.0, xx = 0.0, yy = 0.0, xy = 0.0, n = 0.0;
  for (std::size_t row = reach; row + reach < heights.rows(); ++row) {
    const float* const line = heights.heights_um().data() + row * heights.columns();
    for (std::size_t column = reach; column + reach < heights.columns(); ++column) {
      const double p = difference(line + column, 1) * per_x, q = difference(line + column, heights.columns()) * per_y;
      x += p;
      y += q;
      xx += p * p;
      yy += q * q;
      xy += p * q;
      n += 1.0;
    }
  }
  return {xx / n - x * x / (n * n), yy / n - y * y / (n * n), xy / n - x * y / (n * n)};
}

std::optional<SlopeCovariance> smooth_expectation(const Pattern& pattern, Length pitch) {
  const bool smooth = std::visit([pitch](const auto& kind) { return is_smooth(kind, pitch); }, pattern);
  return smooth ? closed_form_slope_covariance(pattern) : std::nullopt;
}

// from^(−½) (from^½ to from^½)^½ from^(−½).
SlopeCovariance symmetric_factor(const SlopeCovariance& from, const SlopeCovariance& to) {
  const Eigen::Matrix2d root = power(matrix_of(from), 0.5), inverse = power(matrix_of(from), -0.5);
  return covariance_of_matrix(inverse * power(root * matrix_of(to) * root, 0.5) * inverse);
}

SlopeCovariance through(const SlopeCovariance& factor, const SlopeCovariance& c) {
  return covariance_of_matrix(matrix_of(factor) * matrix_of(c) * matrix_of(factor));
}

}  // namespace mezzotint
