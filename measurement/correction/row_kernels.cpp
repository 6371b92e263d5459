#include "measurement/correction/row_kernels.h"

// One translation unit, compiled once for each instruction set; the best that the machine has is taken at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "measurement/correction/row_kernels.cpp"  // NOLINT
#include <hwy/foreach_target.h>                                      // IWYU pragma: keep
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

HWY_BEFORE_NAMESPACE();
namespace mezzotint::HWY_NAMESPACE {

namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Doubles = hn::ScalableTag<double>;
using Floats = hn::Rebind<float, Doubles>;
using Vector = hn::Vec<Doubles>;

// visit(first index, heights as doubles): the rest of a row that fills no vector comes with NaN behind it, as missing.
template <class Visit>
void for_each_vector(std::span<const float> heights, const Visit& visit) {
  const Floats f;
  const Doubles d;
  const std::size_t lanes = hn::Lanes(d);
  std::size_t i = 0;
  for (; i + lanes <= heights.size(); i += lanes) visit(i, hn::PromoteTo(d, hn::LoadU(f, heights.data() + i)));
  if (i == heights.size()) return;
  HWY_ALIGN std::array<float, 64> rest;
  rest.fill(std::numeric_limits<float>::quiet_NaN());
  std::copy(heights.begin() + static_cast<std::ptrdiff_t>(i), heights.end(), rest.begin());
  visit(i, hn::PromoteTo(d, hn::LoadU(f, rest.data())));
}

Vector places_at(RowPlaces places, std::size_t i) {
  const Doubles d;
  const auto index = hn::Add(hn::Iota(d, 0.0), hn::Set(d, static_cast<double>(i)));
  return hn::MulAdd(index, hn::Set(d, places.step), hn::Set(d, places.first));
}

double sum(Vector v) { return hn::GetLane(hn::SumOfLanes(Doubles(), v)); }

void moments(const float* z, std::size_t count, RowPlaces places, double reference, RowMoments* result) {
  const Doubles d;
  auto n = hn::Zero(d), x = n, xx = n, sz = n, xz = n;
  const auto one = hn::Set(d, 1.0), origin = hn::Set(d, reference);
  for_each_vector({z, count}, [&](std::size_t i, Vector v) {
    const auto measured = hn::Eq(v, v);
    const auto place = hn::IfThenElseZero(measured, places_at(places, i));
    const auto height = hn::IfThenElseZero(measured, hn::Sub(v, origin));
    n = hn::Add(n, hn::IfThenElseZero(measured, one));
    x = hn::Add(x, place);
    xx = hn::MulAdd(place, place, xx);
    sz = hn::Add(sz, height);
    xz = hn::MulAdd(place, height, xz);
  });
  *result = {sum(n), sum(x), sum(xx), sum(sz), sum(xz)};
}

// Of vectors that are stored; the rest that fills none goes by way of a buffer.
template <class Make>
void store_each_vector(const float* in, std::size_t count, float* out, const Make& make) {
  const Floats f;
  const std::size_t lanes = hn::Lanes(f);
  for_each_vector({in, count}, [&](std::size_t i, Vector v) {
    const auto made = hn::DemoteTo(f, make(i, v));
    if (i + lanes <= count) return hn::StoreU(made, f, out + i);
    HWY_ALIGN std::array<float, 64> rest;
    hn::StoreU(made, f, rest.data());
    std::copy_n(rest.begin(), count - i, out + i);
  });
}

void subtract(float* z, std::size_t count, RowLine line) {
  store_each_vector(z, count, z, [&](std::size_t i, Vector v) {
    return hn::Sub(v, places_at({line.first_um, line.rise_um}, i));
  });
}

void squares(const float* z, std::size_t count, RowLine line, double* result) {
  auto total = hn::Zero(Doubles());
  for_each_vector({z, count}, [&](std::size_t i, Vector v) {
    const auto off = hn::Sub(v, places_at({line.first_um, line.rise_um}, i));
    const auto measured = hn::IfThenElseZero(hn::Eq(v, v), off);
    total = hn::MulAdd(measured, measured, total);
  });
  *result = sum(total);
}

void beyond(const float* z, std::size_t count, RowLine line, double limit, std::vector<std::uint32_t>* found) {
  const Doubles d;
  const auto most = hn::Set(d, limit);
  for_each_vector({z, count}, [&](std::size_t i, Vector v) {
    const auto off = hn::Abs(hn::Sub(v, places_at({line.first_um, line.rise_um}, i)));
    const auto over = hn::Gt(off, most);
    if (hn::AllFalse(d, over)) return;
    HWY_ALIGN std::array<double, 64> values;
    hn::StoreU(off, d, values.data());
    for (std::size_t k = 0; k < hn::Lanes(d); ++k)
      if (values[k] > limit) found->push_back(static_cast<std::uint32_t>(i + k));
  });
}

void subtract_polynomial(const float* in, std::size_t count, const RowPolynomial& polynomial, float* out) {
  const Doubles d;
  const std::span<const double> c = polynomial.coefficients_um;
  store_each_vector(in, count, out, [&](std::size_t i, Vector v) {
    // Clenshaw's recurrence.
    const auto x = places_at(polynomial.places, i);
    const auto twice = hn::Add(x, x);
    auto b1 = hn::Zero(d), b2 = b1;
    for (std::size_t k = c.size(); k-- > 1;) {
      const auto b0 = hn::MulAdd(twice, b1, hn::Sub(hn::Set(d, c[k]), b2));
      b2 = b1;
      b1 = b0;
    }
    return hn::Sub(v, hn::MulAdd(x, b1, hn::Sub(hn::Set(d, c[0]), b2)));
  });
}

// All sums stay in registers, up to degree 5 or so: their number is known to the compiler.
template <std::size_t degree>
void chebyshev(const float* z, std::size_t count, RowPlaces places, double* weights, double* heights) {
  constexpr std::size_t with_height = degree + 1, all = 2 * degree + 1;
  const Doubles d;
  Vector w[all], h[with_height];  // NOLINT: std::array's own functions are compiled for the baseline
  for (Vector& v : w) v = hn::Zero(d);
  for (Vector& v : h) v = hn::Zero(d);
  for_each_vector({z, count}, [&](std::size_t i, Vector v) {
    const auto measured = hn::Eq(v, v);
    const auto x = places_at(places, i), twice = hn::Add(x, x), value = hn::IfThenElseZero(measured, v);
    auto t = hn::IfThenElseZero(measured, hn::Set(d, 1.0)), next = hn::IfThenElseZero(measured, x);
    for (std::size_t k = 0; k < all; ++k) {
      w[k] = hn::Add(w[k], t);
      if (k < with_height) h[k] = hn::MulAdd(t, value, h[k]);
      const auto after = hn::MulSub(twice, next, t);
      t = next;
      next = after;
    }
  });
  for (std::size_t k = 0; k < all; ++k) weights[k] = sum(w[k]);
  for (std::size_t k = 0; k < with_height; ++k) heights[k] = sum(h[k]);
}

template <std::size_t... degrees>
void chebyshev_of_degree(std::index_sequence<degrees...> /*all*/, std::size_t degree, const float* z, std::size_t count,
                         RowPlaces places, double* weights, double* heights) {
  ((degrees == degree ? chebyshev<degrees>(z, count, places, weights, heights) : void()), ...);
}

void any_chebyshev(std::size_t degree, const float* z, std::size_t count, RowPlaces places, double* weights,
                   double* heights) {
  chebyshev_of_degree(std::make_index_sequence<13>(), degree, z, count, places, weights, heights);
}

}  // namespace

}  // namespace mezzotint::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace mezzotint {

HWY_EXPORT(moments);
HWY_EXPORT(subtract);
HWY_EXPORT(squares);
HWY_EXPORT(beyond);
HWY_EXPORT(subtract_polynomial);
HWY_EXPORT(any_chebyshev);

RowMoments row_moments(std::span<const float> heights_um, RowPlaces places, double reference_um) {
  RowMoments result;
  HWY_DYNAMIC_DISPATCH(moments)(heights_um.data(), heights_um.size(), places, reference_um, &result);
  return result;
}

void subtract_line(std::span<float> heights_um, RowLine line) {
  HWY_DYNAMIC_DISPATCH(subtract)(heights_um.data(), heights_um.size(), line);
}

double squares_above_line(std::span<const float> heights_um, RowLine line) {
  double result = 0.0;
  HWY_DYNAMIC_DISPATCH(squares)(heights_um.data(), heights_um.size(), line, &result);
  return result;
}

void find_beyond(std::span<const float> heights_um, RowLine line, double limit_um, std::vector<std::uint32_t>& found) {
  HWY_DYNAMIC_DISPATCH(beyond)(heights_um.data(), heights_um.size(), line, limit_um, &found);
}

void subtract_row_polynomial(std::span<const float> in_um, const RowPolynomial& polynomial, std::span<float> out_um) {
  HWY_DYNAMIC_DISPATCH(subtract_polynomial)(in_um.data(), in_um.size(), polynomial, out_um.data());
}

void chebyshev_sums(std::span<const float> heights_um, RowPlaces places, std::size_t degree, double* weights,
                    double* heights) {
  HWY_DYNAMIC_DISPATCH(any_chebyshev)(degree, heights_um.data(), heights_um.size(), places, weights, heights);
}

}  // namespace mezzotint

#endif
