#include "measurement/texture/roughness_rows.h"

// One translation unit, compiled once for each instruction set; the best that the machine has is taken at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "measurement/texture/roughness_rows.cpp"  // NOLINT
#include <hwy/foreach_target.h>                                      // IWYU pragma: keep
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace mezzotint::HWY_NAMESPACE {

namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Doubles = hn::ScalableTag<double>;
using Floats = hn::Rebind<float, Doubles>;
using Vector = hn::Vec<Doubles>;
constexpr std::size_t widest = 64;

Vector load(const float* z) { return hn::PromoteTo(Doubles(), hn::LoadU(Floats(), z)); }
double sum(Vector v) { return hn::GetLane(hn::SumOfLanes(Doubles(), v)); }

// visit(vector): the rest of a row that fills no vector comes with NaN behind it, as missing.
template <class Visit>
void for_each_vector(std::span<const float> heights, const Visit& visit) {
  const std::size_t lanes = hn::Lanes(Doubles());
  std::size_t i = 0;
  for (; i + lanes <= heights.size(); i += lanes) visit(load(heights.data() + i));
  if (i == heights.size()) return;
  std::array<float, widest> rest;
  rest.fill(std::numeric_limits<float>::quiet_NaN());
  std::copy(heights.begin() + static_cast<std::ptrdiff_t>(i), heights.end(), rest.begin());
  visit(load(rest.data()));
}

void powers(const float* z, std::size_t count, double reference, PowerSums* result) {
  const Doubles d;
  auto n = hn::Zero(d), first = n, second = n, third = n, fourth = n;
  const auto one = hn::Set(d, 1.0), origin = hn::Set(d, reference);
  for_each_vector({z, count}, [&](Vector v) {
    const auto measured = hn::Eq(v, v);
    const auto height = hn::IfThenElseZero(measured, hn::Sub(v, origin)), square = hn::Mul(height, height);
    n = hn::Add(n, hn::IfThenElseZero(measured, one));
    first = hn::Add(first, height);
    second = hn::Add(second, square);
    third = hn::MulAdd(square, height, third);
    fourth = hn::MulAdd(square, square, fourth);
  });
  *result = {sum(n), sum(first), sum(second), sum(third), sum(fourth)};
}

void deviations(const float* z, std::size_t count, const double* references, double* sums) {
  const Doubles d;
  Vector total[reference_count];  // NOLINT: std::array's own functions are compiled for the baseline
  for (Vector& v : total) v = hn::Zero(d);
  for_each_vector({z, count}, [&](Vector v) {
    const auto measured = hn::Eq(v, v);
    for (std::size_t k = 0; k < reference_count; ++k)
      total[k] = hn::Add(total[k], hn::IfThenElseZero(measured, hn::Abs(hn::Sub(v, hn::Set(d, references[k])))));
  });
  for (std::size_t k = 0; k < reference_count; ++k) sums[k] += sum(total[k]);
}

/// Sums over triangles, a vector of cells at a time.
struct Triangles {
  Vector count, squares, excess;

  void add(Vector slope_x, Vector slope_y) {
    const auto one = hn::Set(Doubles(), 1.0);
    const auto square = hn::MulAdd(slope_x, slope_x, hn::Mul(slope_y, slope_y));
    const auto whole = hn::Eq(square, square);
    const auto counted = hn::IfThenElseZero(whole, square);
    count = hn::Add(count, hn::IfThenElseZero(whole, one));
    squares = hn::Add(squares, counted);
    // √(1+s²) − 1 without cancellation
    excess = hn::Add(excess, hn::Div(counted, hn::Add(one, hn::Sqrt(hn::Add(one, counted)))));
  }
};

void slopes(const float* row, const float* next, std::size_t cells, double per_x, double per_y, SlopeSums* result) {
  const Doubles d;
  const std::size_t lanes = hn::Lanes(d);
  const auto in_x = hn::Set(d, per_x), in_y = hn::Set(d, per_y);
  const auto zero = hn::Zero(d);
  Triangles triangles{zero, zero, zero};
  const auto add = [&](const float* low, const float* high) {
    const auto z00 = load(low), z10 = load(low + 1), z01 = load(high), z11 = load(high + 1);
    // Of a cell with a missing corner neither triangle counts.
    const auto missing = hn::Sub(hn::Add(z00, z11), hn::Add(z00, z11)),
               other = hn::Sub(hn::Add(z10, z01), hn::Add(z10, z01));
    const auto nothing = hn::Add(missing, other);  // 0, or NaN
    triangles.add(hn::MulAdd(hn::Sub(z10, z00), in_x, nothing), hn::Mul(hn::Sub(z11, z10), in_y));
    triangles.add(hn::MulAdd(hn::Sub(z11, z01), in_x, nothing), hn::Mul(hn::Sub(z01, z00), in_y));
  };
  std::size_t i = 0;
  for (; i + lanes <= cells; i += lanes) add(row + i, next + i);
  if (i < cells) {
    std::array<float, widest + 1> low, high;
    low.fill(std::numeric_limits<float>::quiet_NaN());
    high.fill(std::numeric_limits<float>::quiet_NaN());
    std::copy(row + i, row + cells + 1, low.begin());
    std::copy(next + i, next + cells + 1, high.begin());
    add(low.data(), high.data());
  }
  *result = {sum(triangles.count), sum(triangles.squares), sum(triangles.excess)};
}

}  // namespace

}  // namespace mezzotint::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace mezzotint {

HWY_EXPORT(powers);
HWY_EXPORT(deviations);
HWY_EXPORT(slopes);

PowerSums power_sums(std::span<const float> heights_um, double reference_um) {
  PowerSums result;
  HWY_DYNAMIC_DISPATCH(powers)(heights_um.data(), heights_um.size(), reference_um, &result);
  return result;
}

void add_deviations(std::span<const float> heights_um, std::span<const double, reference_count> references_um,
                    std::span<double, reference_count> sums_um) {
  HWY_DYNAMIC_DISPATCH(deviations)(heights_um.data(), heights_um.size(), references_um.data(), sums_um.data());
}

SlopeSums slope_sums(std::span<const float> row_um, std::span<const float> next_row_um, double per_x, double per_y) {
  SlopeSums result;
  if (row_um.size() > 1)
    HWY_DYNAMIC_DISPATCH(slopes)(row_um.data(), next_row_um.data(), row_um.size() - 1, per_x, per_y, &result);
  return result;
}

}  // namespace mezzotint

#endif
