#include "measurement/correction/fill.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <fmt/format.h>
#include <Eigen/SparseCholesky>

#include "forward/base/error.h"
#include "measurement/correction/laplace_multigrid.h"
#include "measurement/correction/laplace_system.h"

namespace mezzotint {

namespace {

// A dense factor of a hole this small costs less than a sparse one's bookkeeping.
constexpr std::size_t small_hole = 48;
// Where a sparse Cholesky factor and multigrid take equally long.
constexpr std::size_t most_factored = 20000;
constexpr std::int32_t not_missing = -1, unseen = -2;

/// The connected holes of a field, one after another.
class Holes {
public:
  explicit Holes(const HeightField& field) : stencil_(field), number_(field.grid().size(), not_missing) {
    for (std::size_t i = 0; i < number_.size(); ++i)
      if (std::isnan(field.heights_um()[i])) number_[i] = unseen;
  }

  /// The samples of the next hole, in ascending order; empty after the last.
  std::vector<std::size_t> next() {
    while (cursor_ < number_.size() && number_[cursor_] != unseen) ++cursor_;
    std::vector<std::size_t> hole;
    if (cursor_ == number_.size()) return hole;
    hole.push_back(cursor_);
    number_[cursor_] = 0;
    for (std::size_t k = 0; k < hole.size(); ++k) {
      stencil_.for_each_neighbour(hole[k], [&](std::size_t index, double) {
        if (number_[index] != unseen) return;
        number_[index] = 0;
        hole.push_back(index);
      });
    }
    std::ranges::sort(hole);
    return hole;
  }

  /// Numbers the samples of a hole, or of several: what `laplace_system` wants.
  const std::vector<std::int32_t>& numbered(const std::vector<std::size_t>& samples) {
    for (std::size_t k = 0; k < samples.size(); ++k) number_[samples[k]] = static_cast<std::int32_t>(k);
    return number_;
  }

private:
  LaplaceStencil stencil_;
  std::vector<std::int32_t> number_;
  std::size_t cursor_ = 0;
};

/// Laplace's equation in a small hole by a dense Cholesky factor on the stack.
class SmallHole {
public:
  SmallHole(const HeightField& field, const std::vector<std::size_t>& samples, const std::vector<std::int32_t>& number)
      : count_(samples.size()) {
    const LaplaceStencil stencil(field);
    for (std::size_t k = 0; k < count_; ++k) {
      right_[k] = 0.0;
      std::fill_n(row(k), k + 1, 0.0);
      stencil.for_each_neighbour(samples[k], [&](std::size_t index, double weight) {
        const std::int32_t other = number[index];
        if (other == static_cast<std::int32_t>(k)) return;
        row(k)[k] += weight;
        if (other < 0)
          right_[k] += weight * static_cast<double>(field.heights_um()[index]);
        else if (static_cast<std::size_t>(other) < k)
          row(k)[other] -= weight;
      });
    }
  }

  /// In place: right_ becomes the solution.
  const double* solve() {
    for (std::size_t i = 0; i < count_; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        double sum = row(i)[j];
        for (std::size_t k = 0; k < j; ++k) sum -= row(i)[k] * row(j)[k];
        row(i)[j] = i == j ? std::sqrt(sum) : sum / row(j)[j];
      }
      for (std::size_t k = 0; k < i; ++k) right_[i] -= row(i)[k] * right_[k];
      right_[i] /= row(i)[i];
    }
    for (std::size_t i = count_; i-- > 0;) {
      for (std::size_t k = i + 1; k < count_; ++k) right_[i] -= row(k)[i] * right_[k];
      right_[i] /= row(i)[i];
    }
    return right_.data();
  }

private:
  double* row(std::size_t k) { return lower_.data() + k * small_hole; }

  std::size_t count_;
  std::array<double, small_hole * small_hole> lower_;
  std::array<double, small_hole> right_;
};

Eigen::VectorXd solve(const LaplaceSystem& system, const std::vector<std::size_t>& samples, std::size_t columns) {
  if (samples.size() > most_factored) return solve_by_multigrid(system, samples, columns);
  const Eigen::SparseMatrix<double> matrix(system.matrix);
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(matrix);
  if (factor.info() != Eigen::Success) throw MethodError("the missing samples could not be filled: no Cholesky factor");
  return factor.solve(system.right_side);
}

template <class Values>
void write(HeightField& field, const std::vector<std::size_t>& samples, const Values& heights_um) {
  for (std::size_t k = 0; k < samples.size(); ++k)
    field.heights_um()[samples[k]] = static_cast<float>(heights_um[static_cast<std::ptrdiff_t>(k)]);
}

double rms_slope(const HeightField& field) {
  const double per_x = 1.0 / field.grid().pitch_x.um(), per_y = 1.0 / field.grid().pitch_y.um();
  double squares = 0.0, count = 0.0;
  const auto add = [&](double rise, double per_um) {
    if (std::isnan(rise)) return;
    squares += rise * rise * per_um * per_um;
    count += 1.0;
  };
  for (std::size_t row = 0; row < field.rows(); ++row)
    for (std::size_t column = 0; column < field.columns(); ++column) {
      const double z = double{field.at(column, row)};
      if (column + 1 < field.columns()) add(double{field.at(column + 1, row)} - z, per_x);
      if (row + 1 < field.rows()) add(double{field.at(column, row + 1)} - z, per_y);
    }
  return count > 0.0 ? std::sqrt(squares / count) : 0.0;
}

}  // namespace

std::string fill_warning(const HeightField& before, const HeightField& filled) {
  constexpr double noticeable = 0.01;
  const double measured = rms_slope(before), whole = rms_slope(filled);
  if (whole > (1.0 - noticeable) * measured) return "";
  return fmt::format(
      "what was filled ({:.3g} % of the samples) is smoother than the surface: slopes of the whole are {:.2g} % "
      "smaller "
      "than those that were measured, heights {:.2g} %. Holes are wider than the features; leave them missing for "
      "roughness",
      100.0 * static_cast<double>(before.missing_count()) / static_cast<double>(before.grid().size()),
      100.0 * (1.0 - whole / measured),
      100.0 * (1.0 - root_mean_square_height(filled) / root_mean_square_height(before)));
}

HeightField fill_missing(const HeightField& field) {
  const std::size_t missing = field.missing_count();
  require(missing < field.grid().size(), "no sample was measured: there is nothing to fill the field from");
  HeightField filled = field;
  if (missing == 0) return filled;
  Holes holes(field);
  std::vector<std::size_t> large;
  for (std::vector<std::size_t> hole = holes.next(); !hole.empty(); hole = holes.next()) {
    if (hole.size() <= small_hole) {
      write(filled, hole, SmallHole(field, hole, holes.numbered(hole)).solve());
    } else {
      large.insert(large.end(), hole.begin(), hole.end());
    }
  }
  if (large.empty()) return filled;
  std::ranges::sort(large);
  const LaplaceSystem system = laplace_system(field, large, holes.numbered(large));
  write(filled, large, solve(system, large, field.columns()));
  return filled;
}

}  // namespace mezzotint
