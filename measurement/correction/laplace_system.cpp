#include "measurement/correction/laplace_system.h"

#include <algorithm>
#include <array>

namespace mezzotint {

LaplaceSystem laplace_system(const HeightField& field, const std::vector<std::size_t>& unknowns,
                             const std::vector<std::int32_t>& number) {
  const auto count = static_cast<Eigen::Index>(unknowns.size());
  LaplaceSystem system;
  system.matrix.resize(count, count);
  system.matrix.reserve(Eigen::VectorX<std::int32_t>::Constant(count, 5));
  system.right_side.setZero(count);
  const LaplaceStencil stencil(field);
  for (Eigen::Index k = 0; k < count; ++k) {
    double diagonal = 0.0;
    stencil.for_each_neighbour(unknowns[static_cast<std::size_t>(k)], [&](std::size_t index, double weight) {
      const std::int32_t other = number[index];
      if (other == k) return;  // a period of one sample: its own neighbour
      diagonal += weight;
      if (other < 0)
        system.right_side[k] += weight * static_cast<double>(field.heights_um()[index]);
      else
        system.matrix.coeffRef(k, other) -= weight;
    });
    system.matrix.coeffRef(k, k) = diagonal;
  }
  system.matrix.makeCompressed();
  return system;
}

}  // namespace mezzotint
