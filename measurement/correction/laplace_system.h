#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/SparseCore>

#include "forward/surface/height_field.h"

/// Inside of measurement/correction.

namespace mezzotint {

/// The four neighbours of a sample with the weights of the five-point Laplacian times dx². Beyond the end of a patch
/// there is none, which is a zero normal derivative; a periodic field wraps.
class LaplaceStencil {
public:
  explicit LaplaceStencil(const HeightField& field)
      : columns_(field.columns()), rows_(field.rows()), periodic_(field.periodic()) {
    const double ratio = field.grid().pitch_x / field.grid().pitch_y;
    weight_y_ = ratio * ratio;
  }

  /// visit(index, weight)
  template <class Visit>
  void for_each_neighbour(std::size_t index, const Visit& visit) const {
    const std::size_t column = index % columns_, row = index / columns_;
    if (column > 0)
      visit(index - 1, 1.0);
    else if (periodic_)
      visit(index + columns_ - 1, 1.0);
    if (column + 1 < columns_)
      visit(index + 1, 1.0);
    else if (periodic_)
      visit(index + 1 - columns_, 1.0);
    const std::size_t whole = columns_ * rows_;
    if (row > 0)
      visit(index - columns_, weight_y_);
    else if (periodic_)
      visit(index + whole - columns_, weight_y_);
    if (row + 1 < rows_)
      visit(index + columns_, weight_y_);
    else if (periodic_)
      visit(index + columns_ - whole, weight_y_);
  }

private:
  std::size_t columns_, rows_;
  bool periodic_;
  double weight_y_ = 1.0;
};

/// Laplace's equation in a set of samples: symmetric, positive definite (every hole has a measured rim).
struct LaplaceSystem {
  Eigen::SparseMatrix<double, Eigen::RowMajor, std::int32_t> matrix;
  Eigen::VectorXd right_side;
};

/// @param unknowns  samples to find, in ascending order; all others that they touch are measured
[[nodiscard]] LaplaceSystem laplace_system(const HeightField& field, const std::vector<std::size_t>& unknowns);

}  // namespace mezzotint
