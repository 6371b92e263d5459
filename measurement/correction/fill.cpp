#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/SparseCholesky>

#include "forward/base/error.h"
#include "measurement/correction/correction.h"

namespace mezzotint {

namespace {

// The factor of a compact hole of n samples holds about 8·n·log2(n) numbers: 10 GB at this many.
constexpr std::size_t most_unknowns = std::size_t{1} << 23;
constexpr std::int32_t measured = -1;

struct Neighbour {
  std::size_t index = 0;
  double weight = 0.0;
};

/// The four neighbours of a sample on the grid, with the weights of the five-point Laplacian times dx². Beyond
/// the end of a patch there is none, which is a zero normal derivative; a periodic field wraps.
class Stencil {
public:
  explicit Stencil(const HeightField& field)
      : columns_(field.columns()), rows_(field.rows()), periodic_(field.periodic()) {
    const double ratio = field.grid().pitch_x / field.grid().pitch_y;
    weight_y_ = ratio * ratio;
  }

  template <class Visit>
  void for_each_neighbour(std::size_t index, const Visit& visit) const {
    const std::size_t column = index % columns_, row = index / columns_;
    if (column > 0 || periodic_) visit(at((column + columns_ - 1) % columns_, row, 1.0));
    if (column + 1 < columns_ || periodic_) visit(at((column + 1) % columns_, row, 1.0));
    if (row > 0 || periodic_) visit(at(column, (row + rows_ - 1) % rows_, weight_y_));
    if (row + 1 < rows_ || periodic_) visit(at(column, (row + 1) % rows_, weight_y_));
  }

private:
  [[nodiscard]] Neighbour at(std::size_t column, std::size_t row, double weight) const {
    return {row * columns_ + column, weight};
  }

  std::size_t columns_, rows_;
  bool periodic_;
  double weight_y_ = 1.0;
};

struct Unknowns {
  std::vector<std::int32_t> number;   // of each sample; `measured` where there is nothing to find
  std::vector<std::size_t> position;  // of each unknown
};

Unknowns number_unknowns(const HeightField& field, std::size_t missing) {
  Unknowns unknowns{std::vector<std::int32_t>(field.grid().size(), measured), {}};
  unknowns.position.reserve(missing);
  for (std::size_t i = 0; i < field.grid().size(); ++i) {
    if (!std::isnan(field.heights_um()[i])) continue;
    unknowns.number[i] = static_cast<std::int32_t>(unknowns.position.size());
    unknowns.position.push_back(i);
  }
  return unknowns;
}

struct LaplaceSystem {
  Eigen::SparseMatrix<double> matrix;  // lower triangle
  Eigen::VectorXd right_side;
};

LaplaceSystem laplace_system(const HeightField& field, const Unknowns& unknowns) {
  const auto count = static_cast<Eigen::Index>(unknowns.position.size());
  LaplaceSystem system;
  system.matrix.resize(count, count);
  system.right_side.setZero(count);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(5 * unknowns.position.size());
  const Stencil stencil(field);
  for (std::int32_t k = 0; k < count; ++k) {
    double diagonal = 0.0;
    stencil.for_each_neighbour(unknowns.position[static_cast<std::size_t>(k)], [&](const Neighbour& neighbour) {
      const std::int32_t other = unknowns.number[neighbour.index];
      if (other == k) return;  // a period of one sample: its own neighbour
      diagonal += neighbour.weight;
      if (other == measured) {
        system.right_side[k] += neighbour.weight * static_cast<double>(field.heights_um()[neighbour.index]);
      } else if (other < k) {
        entries.emplace_back(k, other, -neighbour.weight);
      }
    });
    entries.emplace_back(k, k, diagonal);
  }
  system.matrix.setFromTriplets(entries.begin(), entries.end());
  return system;
}

}  // namespace

// The system is symmetric and positive definite: the grid is connected, so every hole has a measured rim.
HeightField fill_missing(const HeightField& field) {
  const std::size_t missing = field.missing_count();
  require(missing < field.grid().size(), "no sample was measured: there is nothing to fill the field from");
  require(missing <= most_unknowns, std::to_string(missing) + " samples are missing; up to " +
                                        std::to_string(most_unknowns) + " are filled. Crop the field");
  HeightField filled = field;
  if (missing == 0) return filled;
  const Unknowns unknowns = number_unknowns(field, missing);
  const LaplaceSystem system = laplace_system(field, unknowns);
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(system.matrix);
  if (factor.info() != Eigen::Success) throw MethodError("the missing samples could not be filled: no Cholesky factor");
  const Eigen::VectorXd heights_um = factor.solve(system.right_side);
  for (std::size_t k = 0; k < missing; ++k) {
    filled.heights_um()[unknowns.position[k]] = static_cast<float>(heights_um[static_cast<Eigen::Index>(k)]);
  }
  return filled;
}

}  // namespace mezzotint
