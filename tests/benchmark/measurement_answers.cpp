#include "tests/benchmark/measurement_answers.h"

#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <Eigen/SparseCholesky>

#include "measurement/correction/fill.h"
#include "measurement/correction/gaussian_filter.h"
#include "measurement/correction/plane.h"
#include "measurement/correction/polynomial.h"
#include "measurement/texture/autocorrelation.h"
#include "measurement/texture/roughness.h"
#include "tests/benchmark/gwyddion_peer.h"
#include "tests/benchmark/measured_scan.h"

namespace mezzotint::benchmark {

namespace {

// Five-point Laplace equation in all missing samples, no slope across the ends of the patch; heights in double.
std::vector<double> exact_fill(const HeightField& field) {
  const auto columns = static_cast<std::ptrdiff_t>(field.columns()), rows = static_cast<std::ptrdiff_t>(field.rows());
  const double ratio = field.grid().pitch_x / field.grid().pitch_y;
  std::vector<double> heights(field.heights_um().begin(), field.heights_um().end());
  std::vector<std::ptrdiff_t> number(heights.size(), -1), unknowns;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    if (!std::isnan(heights[i])) continue;
    number[i] = static_cast<std::ptrdiff_t>(unknowns.size());
    unknowns.push_back(static_cast<std::ptrdiff_t>(i));
  }
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(unknowns.size()));
  for (std::size_t k = 0; k < unknowns.size(); ++k) {
    const auto here = static_cast<int>(k);
    const std::ptrdiff_t x = unknowns[k] % columns, y = unknowns[k] / columns;
    const auto touch = [&](std::ptrdiff_t nx, std::ptrdiff_t ny, double weight) {
      if (nx < 0 || ny < 0 || nx >= columns || ny >= rows) return;
      const auto at = static_cast<std::size_t>(ny * columns + nx);
      entries.emplace_back(here, here, weight);
      if (number[at] < 0)
        right[here] += weight * heights[at];
      else
        entries.emplace_back(here, static_cast<int>(number[at]), -weight);
    };
    touch(x - 1, y, 1.0);
    touch(x + 1, y, 1.0);
    touch(x, y - 1, ratio * ratio);
    touch(x, y + 1, ratio * ratio);
  }
  Eigen::SparseMatrix<double> matrix(right.size(), right.size());
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(matrix);
  const Eigen::VectorXd solution = factor.solve(right);
  for (std::size_t k = 0; k < unknowns.size(); ++k)
    heights[static_cast<std::size_t>(unknowns[k])] = solution[static_cast<Eigen::Index>(k)];
  return heights;
}

template <class A, class B>
double largest_difference(std::size_t count, const A& a, const B& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < count; ++i) largest = std::max(largest, std::abs(a(i) - b(i)));
  return largest;
}

void compare_fill(const HeightField& holes, double sq_um, const char* words) {
  const std::vector<double> exact = exact_fill(holes);
  const HeightField ours = fill_missing(holes);
  GwyddionField theirs(holes);
  theirs.fill();
  const auto reference = [&](std::size_t i) { return exact[i]; };
  const std::size_t count = exact.size();
  const double mine = largest_difference(count, reference, [&](std::size_t i) { return double{ours.heights_um()[i]}; });
  const double other = largest_difference(count, reference, [&](std::size_t i) { return theirs.value(i); });
  fmt::print("fill, {:<14} largest difference from the exact solution, of Sq: ours {:.1e}, Gwyddion's {:.1e}\n", words,
             mine / sq_um, other / sq_um);
}

// Heights in double on one side, in float on the other: their rounding is what may be left.
void compare_field(const char* name, const HeightField& ours, const GwyddionField& theirs, double sq_um,
                   std::size_t rim) {
  double largest = 0.0;
  for (std::size_t row = rim; row + rim < ours.rows(); ++row)
    for (std::size_t column = rim; column + rim < ours.columns(); ++column)
      largest = std::max(
          largest, std::abs(static_cast<double>(ours.at(column, row)) - theirs.value(row * ours.columns() + column)));
  fmt::print("{:<20} largest difference {:.1e} of Sq\n", name, largest / sq_um);
}

void compare_statistics(const HeightField& field) {
  const AreaRoughness ours = area_roughness(field);
  const GwyddionField::Statistics theirs = GwyddionField(field).statistics();
  const auto row = [](const char* name, double mine, double other, const char* note) {
    fmt::print("{:<4} ours {:<12.8g} Gwyddion's {:<12.8g} difference {:.1e} {}\n", name, mine, other,
               std::abs(mine / other - 1.0), note);
  };
  row("Sa", ours.Sa.value, theirs.Sa, "");
  row("Sq", ours.Sq.value, theirs.Sq, "");
  row("Sz", ours.Sz.value, theirs.Sz, "");
  row("Ssk", ours.Ssk.value, theirs.Ssk, "");
  row("Sku", ours.Sku.value, theirs.Sku_excess + 3.0, "(its excess + 3)");
  row("Sdq", ours.Sdq.value, theirs.Sdq, "(other differences, by definition)");
  row("Sdr", ours.Sdr.value, theirs.Sdr, "(other triangles and a flat rim, by definition)");
}

}  // namespace

void print_answers(std::size_t size) {
  fmt::print("\nanswers on {0} x {0} samples\n", size);
  const HeightField scan = measured_scan(size), flat = level(scan), holes = scan_with_holes(size);
  const double sq_um = area_roughness(flat).Sq.value;
  compare_statistics(flat);
  compare_fill(holes, sq_um, "dx = dy");
  const Grid stretched{size, size, Length::from_um(2.0), Length::from_um(1.0)};
  compare_fill(HeightField(stretched, Continuation::Mirrored, {holes.heights_um().begin(), holes.heights_um().end()}),
               sq_um, "dx = 2 dy");
  GwyddionField levelled(scan), bent(scan), smooth(scan);
  levelled.level();
  compare_field("plane", flat, levelled, sq_um, 0);
  bent.level_by_polynomial(5);
  compare_field("polynomial 5", subtract_polynomial(scan, fit_polynomial(scan, 5)), bent, sq_um, 0);
  smooth.filter(10.0);
  compare_field("filter, inside", s_filter(scan, Length::from_um(10.0)), smooth, sq_um, 16);
  const Autocorrelation ours = autocorrelation(flat);
  const GwyddionField theirs(flat);
  const auto [columns, rows, values] = theirs.autocorrelation();
  const double middle = values[rows / 2 * columns + columns / 2];
  double largest = 0.0;
  for (std::ptrdiff_t y = -64; y <= 64; ++y)
    for (std::ptrdiff_t x = -64; x <= 64; ++x) {
      const auto at = (static_cast<std::ptrdiff_t>(rows / 2) + y) * static_cast<std::ptrdiff_t>(columns) +
                      static_cast<std::ptrdiff_t>(columns / 2) + x;
      largest = std::max(largest, std::abs(ours.at(x, y) - values[static_cast<std::size_t>(at)] / middle));
    }
  fmt::print("{:<20} largest difference {:.1e} at lags up to 64\n", "autocorrelation", largest);
}

}  // namespace mezzotint::benchmark
