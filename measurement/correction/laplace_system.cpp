#include "measurement/correction/laplace_system.h"

#include <algorithm>
#include <cmath>

namespace mezzotint {

namespace {

/// Numbers of samples in an ascending list. Rows are short: what is sought lies in the row of the last one found, or in
/// one beside it.
class Numbers {
public:
  Numbers(const std::vector<std::size_t>& unknowns, const Grid& grid)
      : unknowns_(unknowns), columns_(grid.columns), row_begin_(grid.rows + 1, unknowns.size()) {
    std::size_t k = 0;
    for (std::size_t row = 0; row < grid.rows; ++row) {
      while (k < unknowns.size() && unknowns[k] < row * columns_) ++k;
      row_begin_[row] = k;
    }
  }
  /// Of a sample that is in the list.
  [[nodiscard]] std::int32_t of(std::size_t index) const {
    const std::size_t row = index / columns_;
    const auto begin = unknowns_.begin();
    const auto found = std::lower_bound(begin + static_cast<std::ptrdiff_t>(row_begin_[row]),
                                        begin + static_cast<std::ptrdiff_t>(row_begin_[row + 1]), index);
    return static_cast<std::int32_t>(found - begin);
  }

private:
  const std::vector<std::size_t>& unknowns_;
  std::size_t columns_;
  std::vector<std::size_t> row_begin_;
};

}  // namespace

LaplaceSystem laplace_system(const HeightField& field, const std::vector<std::size_t>& unknowns) {
  const auto count = static_cast<Eigen::Index>(unknowns.size());
  LaplaceSystem system;
  system.matrix.resize(count, count);
  system.matrix.reserve(Eigen::VectorX<std::int32_t>::Constant(count, 5));
  system.right_side.setZero(count);
  const LaplaceStencil stencil(field);
  const Numbers numbers(unknowns, field.grid());
  for (Eigen::Index k = 0; k < count; ++k) {
    const std::size_t here = unknowns[static_cast<std::size_t>(k)];
    double diagonal = 0.0;
    stencil.for_each_neighbour(here, [&](std::size_t index, double weight) {
      if (index == here) return;  // a period of one sample: its own neighbour
      diagonal += weight;
      const double z = static_cast<double>(field.heights_um()[index]);
      if (std::isnan(z))
        system.matrix.coeffRef(k, numbers.of(index)) -= weight;
      else
        system.right_side[k] += weight * z;
    });
    system.matrix.coeffRef(k, k) = diagonal;
  }
  system.matrix.makeCompressed();
  return system;
}

}  // namespace mezzotint
