#include "measurement/correction/laplace_multigrid.h"

#include <cmath>
#include <unordered_map>

#include <Eigen/SparseCholesky>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor, std::int32_t>;
using Vector = Eigen::VectorXd;

// Below this a sparse factor is quicker than another grid.
constexpr Eigen::Index coarsest = 2000;
constexpr double tolerance = 1e-11;
constexpr int most_iterations = 200;

struct Place {
  std::size_t x = 0, y = 0;
};

struct Grids {
  std::vector<Place> places;  // of the unknowns of a level
  Matrix matrix, up;          // up: from the next coarser level
};

// Unknown (x, y) with both even lives on the coarser grid too; the others lie between two or four of its nodes, and
// take a share of those that exist there (the others are rim, where the correction is 0).
Matrix interpolation(const std::vector<Place>& fine, std::vector<Place>& coarse) {
  std::unordered_map<std::size_t, std::int32_t> number;
  const auto key = [](std::size_t x, std::size_t y) { return (y << 32U) | x; };
  for (const Place& place : fine) {
    if (place.x % 2 != 0 || place.y % 2 != 0) continue;
    number.emplace(key(place.x / 2, place.y / 2), static_cast<std::int32_t>(coarse.size()));
    coarse.push_back({place.x / 2, place.y / 2});
  }
  std::vector<Eigen::Triplet<double, std::int32_t>> entries;
  for (std::size_t k = 0; k < fine.size(); ++k) {
    const auto [x, y] = fine[k];
    const double share = (x % 2 == 0 ? 1.0 : 0.5) * (y % 2 == 0 ? 1.0 : 0.5);
    for (std::size_t cy = y / 2; cy <= (y + 1) / 2; ++cy)
      for (std::size_t cx = x / 2; cx <= (x + 1) / 2; ++cx) {
        const auto found = number.find(key(cx, cy));
        if (found != number.end()) entries.emplace_back(static_cast<std::int32_t>(k), found->second, share);
      }
  }
  Matrix up(static_cast<Eigen::Index>(fine.size()), static_cast<Eigen::Index>(coarse.size()));
  up.setFromTriplets(entries.begin(), entries.end());
  return up;
}

// One sweep of Gauss–Seidel; forward, or backward so that a pair of them is symmetric.
void sweep(const Matrix& matrix, const Vector& right, Vector& x, bool forward) {
  const Eigen::Index count = matrix.rows();
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index row = forward ? i : count - 1 - i;
    double sum = right[row], diagonal = 1.0;
    for (Matrix::InnerIterator entry(matrix, row); entry; ++entry) {
      if (entry.col() == row)
        diagonal = entry.value();
      else
        sum -= entry.value() * x[entry.col()];
    }
    x[row] = sum / diagonal;
  }
}

class Multigrid {
public:
  Multigrid(const Matrix& matrix, const std::vector<std::size_t>& positions, std::size_t columns) {
    Grids finest;
    finest.matrix = matrix;
    for (const std::size_t position : positions) finest.places.push_back({position % columns, position / columns});
    levels_.push_back(std::move(finest));
    while (levels_.back().matrix.rows() > coarsest) {
      std::vector<Place> coarse;
      Grids& fine = levels_.back();
      fine.up = interpolation(fine.places, coarse);
      if (coarse.empty()) break;
      Grids next;
      next.matrix = Matrix(fine.up.transpose()) * fine.matrix * fine.up;
      next.places = std::move(coarse);
      levels_.push_back(std::move(next));
    }
    factored_ = levels_.back().matrix.rows() <= coarsest;
    if (factored_) factor_.compute(Eigen::SparseMatrix<double>(levels_.back().matrix));
  }

  [[nodiscard]] Vector cycle(const Vector& right, std::size_t level = 0) const {
    const Grids& grid = levels_[level];
    if (level + 1 == levels_.size() && factored_) return factor_.solve(right);
    Vector x = Vector::Zero(right.size());
    sweep(grid.matrix, right, x, true);
    if (level + 1 < levels_.size()) {
      const Vector rest = right - grid.matrix * x;
      x += grid.up * cycle(grid.up.transpose() * rest, level + 1);
    }
    sweep(grid.matrix, right, x, false);
    return x;
  }

private:
  std::vector<Grids> levels_;
  bool factored_ = false;  // scattered unknowns may leave nothing for a coarser grid, and need none
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
};

}  // namespace

Vector solve_by_multigrid(const LaplaceSystem& system, const std::vector<std::size_t>& positions, std::size_t columns) {
  const Multigrid multigrid(system.matrix, positions, columns);
  Vector x = Vector::Zero(system.right_side.size()), rest = system.right_side;
  const double goal = tolerance * rest.norm();
  Vector better = multigrid.cycle(rest), direction = better;
  double product = rest.dot(better);
  for (int iteration = 0; iteration < most_iterations && rest.norm() > goal; ++iteration) {
    const Vector image = system.matrix * direction;
    const double step = product / direction.dot(image);
    x += step * direction;
    rest -= step * image;
    better = multigrid.cycle(rest);
    const double next = rest.dot(better);
    direction = better + next / product * direction;
    product = next;
  }
  if (!(rest.norm() <= goal)) throw MethodError("the missing samples could not be filled: the solver did not converge");
  return x;
}

}  // namespace mezzotint
