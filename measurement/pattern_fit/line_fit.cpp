#include "measurement/pattern_fit/line_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <tbb/parallel_for.h>
#include <Eigen/Dense>

#include "measurement/correction/fill.h"
#include "measurement/pattern_fit/line_start.h"

namespace mezzotint {

namespace {

constexpr int most_rounds = 60;
constexpr auto size = static_cast<Eigen::Index>(line_numbers);
using Matrix = Eigen::Matrix<double, size, size>;
using Vector = Eigen::Matrix<double, size, 1>;

// JᵀJ, Jᵀr and |r|² of the residual r.
struct Normal {
  Matrix matrix = Matrix::Zero();
  Vector right = Vector::Zero();
  double square = 0.0, count = 0.0;
};

// Row by row at once, added up in order: the same bits with any number of threads.
Normal normal_equations(LineKind kind, const LineNumbers& numbers, const HeightField& field) {
  std::vector<Normal> rows(field.rows());
  tbb::parallel_for(std::size_t{0}, field.rows(), [&](std::size_t row) {
    Normal& own = rows[row];
    LineGradient gradient;
    for (std::size_t column = 0; column < field.columns(); ++column) {
      const double z = field.at(column, row);
      if (std::isnan(z)) continue;
      const double x = static_cast<double>(column) * field.grid().pitch_x.um();
      const double residual =
          z - line_height(kind, numbers, x, static_cast<double>(row) * field.grid().pitch_y.um(), gradient);
      const Eigen::Map<const Vector> g(gradient.data());
      own.matrix.selfadjointView<Eigen::Lower>().rankUpdate(g);
      own.right += residual * g;
      own.square += residual * residual;
      own.count += 1.0;
    }
  });
  Normal sum;
  for (const Normal& row : rows) {
    sum.matrix += row.matrix;
    sum.right += row.right;
    sum.square += row.square;
    sum.count += row.count;
  }
  sum.matrix = Matrix(sum.matrix.selfadjointView<Eigen::Lower>());
  return sum;
}

// Numbers that a kind lacks have no derivative: they are held.
Matrix inverse_in_units(const Matrix& matrix, double damping) {
  Vector unit = matrix.diagonal().cwiseSqrt();
  for (Eigen::Index i = 0; i < size; ++i) unit[i] = unit[i] > 0.0 ? 1.0 / unit[i] : 0.0;
  Matrix scaled = unit.asDiagonal() * matrix * unit.asDiagonal();
  for (Eigen::Index i = 0; i < size; ++i) scaled(i, i) = unit[i] > 0.0 ? scaled(i, i) + damping : 1.0;
  return unit.asDiagonal() * Matrix(scaled.ldlt().solve(Matrix(Matrix::Identity()))) * unit.asDiagonal();
}

LineNumbers moved(LineNumbers numbers, const Vector& step) {
  const auto all = members(numbers);
  for (std::size_t i = 0; i < line_numbers; ++i) *all.at(i) += step[static_cast<Eigen::Index>(i)];
  numbers.skew = std::clamp(numbers.skew, 0.01, 0.99);
  return numbers;
}

Normal descend(LineKind kind, LineNumbers& numbers, const HeightField& field) {
  Normal at = normal_equations(kind, numbers, field);
  double damping = 1e-3;
  for (int round = 0; round < most_rounds && damping < 1e8;) {
    const LineNumbers tried = moved(numbers, inverse_in_units(at.matrix, damping) * at.right);
    Normal there = normal_equations(kind, tried, field);
    ++round;
    if (!(there.square < at.square)) {
      damping *= 10.0;
      continue;
    }
    const bool last = at.square - there.square < 1e-10 * at.square;
    numbers = tried;
    at = there;
    damping = std::max(1e-12, 0.1 * damping);
    if (last) break;
  }
  return at;
}

HeightField residual_of(LineKind kind, const LineNumbers& numbers, const HeightField& field) {
  HeightField residual = field;
  LineGradient unused;
  for (std::size_t row = 0; row < field.rows(); ++row)
    for (std::size_t column = 0; column < field.columns(); ++column)
      residual.at(column, row) =
          static_cast<float>(double{field.at(column, row)} -
                             line_height(kind, numbers, static_cast<double>(column) * field.grid().pitch_x.um(),
                                         static_cast<double>(row) * field.grid().pitch_y.um(), unused));
  return residual;
}

// Upper tail of χ² by Wilson and Hilferty.
double tail_of_chi_square(double value, double freedom) {
  const double spread = 2.0 / (9.0 * freedom);
  return 0.5 * std::erfc((std::cbrt(value / freedom) - 1.0 + spread) / std::sqrt(2.0 * spread));
}

// χ² of mean densities in eight rings of equally many frequencies, and in eight sectors, against their common mean.
double flatness_of(const FitView& view, const std::vector<double>& density) {
  constexpr std::size_t parts = 8;
  std::vector<double> radius;
  for (const FrequencyBlock& block : view.blocks()) radius.push_back(std::hypot(block.x_per_um, block.y_per_um));
  std::vector<std::size_t> order(radius.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::sort(order, [&radius](std::size_t a, std::size_t b) { return radius[a] < radius[b]; });
  double total = 0.0, power = 0.0, before = 0.0;
  for (std::size_t i = 0; i < density.size(); ++i) {
    total += view.blocks()[i].count;
    power += view.blocks()[i].count * density[i];
  }
  std::vector<double> sums(2 * parts), counts(2 * parts);
  for (const std::size_t i : order) {
    const FrequencyBlock& block = view.blocks()[i];
    const double turn = std::atan2(block.y_per_um, block.x_per_um) / std::numbers::pi + 1.0;
    const auto ring = std::min(static_cast<std::size_t>(before / total * parts), parts - 1);
    const std::size_t sector = parts + static_cast<std::size_t>((turn - std::floor(turn)) * parts) % parts;
    for (const std::size_t part : {ring, sector}) {
      sums[part] += block.count * density[i];
      counts[part] += block.count;
    }
    before += block.count;
  }
  double square = 0.0;
  for (std::size_t part = 0; part < 2 * parts; ++part) {
    const double ratio = sums[part] / std::max(1.0, counts[part]) / (power / total);
    square += (ratio - 1.0) * (ratio - 1.0) * counts[part] * FitView::independent_share;
  }
  return tail_of_chi_square(square, 2.0 * (parts - 1));
}

// Mean density of the residual within an octave to both sides of the line.
double density_beside(const FitView& view, const std::vector<double>& density, double line_per_um) {
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < density.size(); ++i) {
    const double ratio = std::hypot(view.blocks()[i].x_per_um, view.blocks()[i].y_per_um) / line_per_um;
    if (ratio < 0.5 || ratio > 2.0) continue;
    sum += view.blocks()[i].count * density[i];
    count += view.blocks()[i].count;
  }
  return count > 0.0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

double mean_square(const HeightField& field) {
  double sum = 0.0, count = 0.0;
  for (const float z : field.heights_um()) {
    if (std::isnan(z)) continue;
    sum += double{z} * double{z};
    count += 1.0;
  }
  return sum / count;
}

// The numbers' errors from the noise at the lines.
void set_errors(LineFit& fit, const Normal& at, const FitView& view, const std::vector<double>& density) {
  const double line = std::hypot(fit.numbers.waves_u_per_um, fit.numbers.waves_v_per_um);
  const double beside = density_beside(view, density, line) / (view.grid().pitch_x.um() * view.grid().pitch_y.um());
  const double rounding = 3e-8 * fit.numbers.height_um;
  const double variance = std::max({std::isnan(beside) ? 0.0 : beside, at.square / at.count, rounding * rounding});
  const Matrix covariance = variance * inverse_in_units(at.matrix, 0.0);
  const auto errors = members(fit.errors);
  for (std::size_t i = 0; i < line_numbers; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    *errors.at(i) = std::sqrt(std::max(0.0, covariance(k, k)));
  }
}

}  // namespace

std::optional<LineFit> fit_lines(LineKind kind, const FitView& view, const HeightField& seen) {
  const auto start = line_start(kind, seen.missing_count() > 0 ? fill_missing(seen) : seen);
  if (!start) return {};
  LineFit fit{.kind = kind, .numbers = *start};
  const Normal at = descend(kind, fit.numbers, seen);
  const HeightField residual = residual_of(kind, fit.numbers, seen);
  const std::vector<double> density = view.periodogram(residual);
  set_errors(fit, at, view, density);
  const LineNumbers found = fit.numbers;
  fit.numbers = in_reported_form(kind, found);
  if (fit.numbers.waves_u_per_um != std::abs(found.waves_u_per_um))
    std::swap(fit.errors.waves_u_per_um, fit.errors.waves_v_per_um);
  const Grid& grid = view.grid();
  const double side = std::min(static_cast<double>(grid.columns) * grid.pitch_x.um(),
                               static_cast<double>(grid.rows) * grid.pitch_y.um());
  fit.waves = side * fit.numbers.waves_u_per_um;
  if (kind == LineKind::Sinusoid) fit.waves = std::min(fit.waves, side * fit.numbers.waves_v_per_um);
  fit.residual_um = std::sqrt(at.square / at.count);
  fit.share_left = at.square / at.count / mean_square(seen);
  fit.flatness = flatness_of(view, density);
  return fit;
}

}  // namespace mezzotint
