#include "inverse/objective/light_moments.h"

#include <cmath>

#include <Eigen/Eigenvalues>

namespace mezzotint {

namespace {

// A lobe narrower than this share of a bin is as narrow as can be told; keeps covariances invertible.
constexpr double least_width_bins = 1e-3;

Eigen::Matrix2d regular(const SmoothGrid& grid, const Eigen::Matrix2d& covariance) {
  const double bin = 2.0 / static_cast<double>(grid.grid().width);
  return covariance + std::pow(least_width_bins * bin, 2) * Eigen::Matrix2d::Identity();
}

struct Spectral {
  Eigen::Vector2d values;
  Eigen::Matrix2d vectors;

  explicit Spectral(const Eigen::Matrix2d& matrix) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(matrix);
    values = solver.eigenvalues();
    vectors = solver.eigenvectors();
  }
  template <class Function>
  [[nodiscard]] Eigen::Matrix2d of(const Function& function) const {
    return vectors * values.unaryExpr(function).asDiagonal() * vectors.transpose();
  }
};

}  // namespace

Eigen::Vector2d bin_middle(const DirectionGrid& grid, std::size_t bin) {
  const std::size_t row = bin / grid.width, column = bin - row * grid.width;
  return {(2.0 * static_cast<double>(column) + 1.0) / static_cast<double>(grid.width) - 1.0,
          (2.0 * static_cast<double>(row) + 1.0) / static_cast<double>(grid.height) - 1.0};
}

LightMoments light_moments(const SmoothGrid& grid, std::span<const double> lobe) {
  LightMoments moments;
  for (std::size_t k = 0; k < lobe.size(); ++k) {
    const double light = grid.areas()[k] * lobe[k];
    moments.light += light;
    moments.mean += light * bin_middle(grid.grid(), k);
  }
  moments.mean /= moments.light;
  for (std::size_t k = 0; k < lobe.size(); ++k) {
    const Eigen::Vector2d off = bin_middle(grid.grid(), k) - moments.mean;
    moments.covariance += grid.areas()[k] * lobe[k] / moments.light * off * off.transpose();
  }
  return moments;
}

// With M = G^(−½) F G^(−½): ∂‖log M‖²/∂F = 2 G^(−½) M^(−1) log(M) G^(−½); and of the moments toward the light p of a
// bin at x: ∂E/∂p = 1, ∂mean/∂p = (x − mean)/E, ∂F/∂p = ((x − mean)(x − mean)ᵀ − F)/E.
DistanceWithSlopes moment_distance(const SmoothGrid& grid, std::span<const double> f, std::span<const double> g) {
  const LightMoments found = light_moments(grid, f), wanted = light_moments(grid, g);
  const Eigen::Matrix2d own = regular(grid, wanted.covariance);
  const Eigen::Matrix2d root = Spectral(own).of([](double v) { return 1.0 / std::sqrt(v); });
  const Spectral relative(root * regular(grid, found.covariance) * root);
  const Eigen::Vector2d shift = found.mean - wanted.mean, pull = own.inverse() * shift;
  const double brighter = std::log(found.light / wanted.light);
  const Eigen::Matrix2d toward_covariance = 2.0 * root * relative.of([](double v) { return std::log(v) / v; }) * root;
  DistanceWithSlopes result;
  result.value = shift.dot(pull) + relative.values.array().log().square().sum() + brighter * brighter;
  result.slopes.resize(f.size());
  for (std::size_t k = 0; k < f.size(); ++k) {
    const Eigen::Vector2d off = bin_middle(grid.grid(), k) - found.mean;
    const double widening = off.dot(toward_covariance * off) - toward_covariance.cwiseProduct(found.covariance).sum();
    result.slopes[k] = grid.areas()[k] / found.light * (2.0 * pull.dot(off) + widening + 2.0 * brighter);
  }
  return result;
}

}  // namespace mezzotint
