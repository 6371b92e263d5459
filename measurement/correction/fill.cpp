#include "measurement/correction/fill.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
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

/// The connected holes of a field, one after another.
class Holes {
public:
  explicit Holes(const HeightField& field) : stencil_(field), unseen_((field.grid().size() + 63) / 64, 0) {
    const auto heights_um = field.heights_um();
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, unseen_.size(), 4096), [&](const auto& words) {
      for (std::size_t word = words.begin(); word < words.end(); ++word) {
        const auto part = heights_um.subspan(64 * word, std::min<std::size_t>(64, heights_um.size() - 64 * word));
        std::uint64_t bits = 0;
        for (std::size_t k = 0; k < part.size(); ++k) bits |= std::uint64_t{std::isnan(part[k])} << k;
        unseen_[word] = bits;
      }
    });
  }

  /// Appends the samples of the next hole, in ascending order; none after the last.
  void next(std::vector<std::size_t>& samples) {
    while (cursor_ < unseen_.size() && unseen_[cursor_] == 0) ++cursor_;
    if (cursor_ == unseen_.size()) return;
    const std::size_t begin = samples.size();
    take(64 * cursor_ + static_cast<std::size_t>(std::countr_zero(unseen_[cursor_])), samples);
    for (std::size_t k = begin; k < samples.size(); ++k)
      stencil_.for_each_neighbour(samples[k], [&](std::size_t index, double) {
        if ((unseen_[index / 64] >> index % 64 & 1U) != 0) take(index, samples);
      });
    std::sort(samples.begin() + static_cast<std::ptrdiff_t>(begin), samples.end());
  }

private:
  void take(std::size_t index, std::vector<std::size_t>& samples) {
    unseen_[index / 64] &= ~(std::uint64_t{1} << index % 64);
    samples.push_back(index);
  }

  LaplaceStencil stencil_;
  std::vector<std::uint64_t> unseen_;  // a bit a sample
  std::size_t cursor_ = 0;
};

/// Laplace's equation in a small hole by a dense Cholesky factor on the stack.
class SmallHole {
public:
  SmallHole(const HeightField& field, std::span<const std::size_t> samples) : count_(samples.size()) {
    const LaplaceStencil stencil(field);
    for (std::size_t k = 0; k < count_; ++k) {
      right_[k] = 0.0;
      std::fill_n(row(k), k + 1, 0.0);
      stencil.for_each_neighbour(samples[k], [&](std::size_t index, double weight) {
        if (index == samples[k]) return;  // a period of one sample: its own neighbour
        row(k)[k] += weight;
        const double z = static_cast<double>(field.heights_um()[index]);
        if (!std::isnan(z)) {
          right_[k] += weight * z;
        } else if (index < samples[k]) {
          row(k)[std::ranges::lower_bound(samples, index) - samples.begin()] -= weight;
        }
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
void write(HeightField& field, std::span<const std::size_t> samples, const Values& heights_um) {
  for (std::size_t k = 0; k < samples.size(); ++k)
    field.heights_um()[samples[k]] = static_cast<float>(heights_um[static_cast<std::ptrdiff_t>(k)]);
}

/// Small holes, one behind another; each is filled by itself.
struct SmallHoles {
  std::vector<std::size_t> samples, begins;

  void fill(HeightField& field) const {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, begins.size(), 256), [&](const auto& holes) {
      for (std::size_t k = holes.begin(); k < holes.end(); ++k) {
        const std::size_t end = k + 1 < begins.size() ? begins[k + 1] : samples.size();
        const auto hole = std::span(samples).subspan(begins[k], end - begins[k]);
        // What a hole borders on was measured: none sees what another writes.
        write(field, hole, SmallHole(field, hole).solve());
      }
    });
  }
};

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

HeightField fill_missing(HeightField field) {
  const std::size_t missing = field.missing_count();
  require(missing < field.grid().size(), "no sample was measured: there is nothing to fill the field from");
  if (missing == 0) return field;
  SmallHoles small;
  std::vector<std::size_t> large;
  {
    Holes holes(field);
    for (std::size_t begin = 0;; begin = small.samples.size()) {
      holes.next(small.samples);
      const std::size_t found = small.samples.size() - begin;
      if (found == 0) break;
      if (found <= small_hole) {
        small.begins.push_back(begin);
        continue;
      }
      large.insert(large.end(), small.samples.begin() + static_cast<std::ptrdiff_t>(begin), small.samples.end());
      small.samples.resize(begin);
    }
  }
  if (!large.empty()) {
    std::ranges::sort(large);
    write(field, large, solve(laplace_system(field, large), large, field.columns()));
  }
  small.fill(field);
  return field;
}

}  // namespace mezzotint
