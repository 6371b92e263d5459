#include "inverse/objective/lobe_kernels.h"

// One translation unit, compiled once for each instruction set; the best that the machine has is taken at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "inverse/objective/lobe_kernels.cpp"  // NOLINT
#include <hwy/foreach_target.h>                                  // IWYU pragma: keep
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace mezzotint::HWY_NAMESPACE {

namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Points at a time: what is known of them stays in the first-level cache, beside the bins.
constexpr std::size_t chunk = 128;

// Nothing is fused anywhere, so that every width of vector gives the same bits.
using Doubles = hn::CappedTag<double, chunk>;
using Floats = hn::Rebind<float, Doubles>;
using Integers = hn::Rebind<std::int32_t, Doubles>;
using Indices = hn::RebindToSigned<Doubles>;
using Vector = hn::Vec<Doubles>;
using Index = hn::Vec<Indices>;

Vector number(double value) { return hn::Set(Doubles(), value); }

// A facet with slopes p, q as the light meets it: s = n·(ω_i·m), k = 2 s/n², and whether it sends light upward.
struct Facet {
  Vector p, q, inverse_square, s, k;
  hn::Mask<Doubles> lit;
};
Facet facet_at(const LobePlan& plan, const float* slopes_x, const float* slopes_y) {
  const Doubles d;
  const Vector p = hn::PromoteTo(d, hn::LoadU(Floats(), slopes_x));
  const Vector q = hn::PromoteTo(d, hn::LoadU(Floats(), slopes_y));
  const Vector square = hn::Add(hn::Add(number(1.0), hn::Mul(p, p)), hn::Mul(q, q));
  const Vector inverse_square = hn::Div(number(1.0), square);
  const Vector s = hn::Sub(hn::Sub(number(plan.to_light_z), hn::Mul(p, number(plan.to_light_x))),
                           hn::Mul(q, number(plan.to_light_y)));
  const Vector k = hn::Mul(hn::Mul(number(2.0), s), inverse_square);
  return {p, q, inverse_square, s, k, hn::And(hn::Gt(s, hn::Zero(d)), hn::Gt(k, number(plan.to_light_z)))};
}

// Value and slope of a curve, at x within 0 and 1.
struct CurvePoint {
  Vector value, slope;
};
template <bool with_slope>
CurvePoint on_curve(const CurveCells& curve, Vector x) {
  const Doubles d;
  const Indices indices;
  const auto steps = static_cast<std::int32_t>(curve.steps);
  const Vector at = hn::Mul(x, number(steps));
  const auto cell = hn::Min(hn::DemoteTo(Integers(), at), hn::Set(Integers(), steps - 1));
  const Vector t = hn::Sub(at, hn::PromoteTo(d, cell));
  const Index first = hn::ShiftLeft<2>(hn::PromoteTo(indices, cell));
  const double* const terms = curve.terms.data();
  const Vector a = hn::GatherIndex(d, terms, first), b = hn::GatherIndex(d, terms + 1, first),
               c = hn::GatherIndex(d, terms + 2, first), e = hn::GatherIndex(d, terms + 3, first);
  const auto horner = [&](Vector sum, Vector next) { return hn::Add(hn::Mul(sum, t), next); };
  CurvePoint point{horner(horner(horner(a, b), c), e), c};
  if constexpr (with_slope) {
    const Vector slope = horner(horner(hn::Mul(number(3.0), a), hn::Mul(number(2.0), b)), c);
    point.slope = hn::Mul(slope, number(steps));
  }
  return point;
}

// The nearest bin along one axis, and how far from its middle.
struct Place {
  hn::Vec<Integers> bin;
  Vector t;
};
Place place_of(Vector way, std::size_t bins) {
  const Doubles d;
  const Vector coordinate = hn::Mul(number(0.5 * static_cast<double>(bins)), hn::Add(way, number(1.0)));
  const auto last = hn::Set(Integers(), static_cast<std::int32_t>(bins) - 1);
  const auto bin = hn::Max(hn::Zero(Integers()), hn::Min(hn::DemoteTo(Integers(), coordinate), last));
  return {bin, hn::Sub(hn::Sub(coordinate, hn::PromoteTo(d, bin)), number(0.5))};
}

// The shares of three bins and their slopes, as soft_bins.
struct Shares {
  Vector before, middle, after, slope_before, slope_middle, slope_after;
};
Shares shares_of(Vector t) {
  const Vector half = number(0.5), low = hn::Sub(half, t), high = hn::Add(half, t);
  return {hn::Mul(half, hn::Mul(low, low)),   hn::Sub(number(0.75), hn::Mul(t, t)),
          hn::Mul(half, hn::Mul(high, high)), hn::Neg(low),
          hn::Mul(number(-2.0), t),           high};
}

// Where light goes that a facet does not send upward: to the middle, with no weight.
struct Way {
  Vector x, y;
};
Way way_of(const LobePlan& plan, const Facet& facet) {
  const auto along = [&](Vector slope, double to_light) {
    return hn::IfThenElseZero(facet.lit, hn::Sub(hn::Neg(hn::Mul(facet.k, slope)), number(to_light)));
  };
  return {along(facet.p, plan.to_light_x), along(facet.q, plan.to_light_y)};
}

Vector cosine_of(const Facet& facet) {
  const Vector cosine = hn::Mul(facet.s, hn::Sqrt(facet.inverse_square));
  return hn::IfThenElseZero(facet.lit, hn::Min(number(1.0), cosine));
}

// The light of a chunk: the shares along x, those along y times the weight, and the first bin of the nine.
struct Sent {
  HWY_ALIGN std::array<double, chunk> x0, x1, x2, y0, y1, y2;
  HWY_ALIGN std::array<std::int32_t, chunk> corner;
};

void send(const LobePlan& plan, const FacetSlopes& slopes, Sent& sent) {
  const Doubles d;
  const auto stride = hn::Set(Integers(), static_cast<std::int32_t>(plan.framed_stride()));
  const Vector by_cosine = number(1.0 / plan.to_light_z);
  for (std::size_t i = 0; i < slopes.count; i += hn::Lanes(d)) {
    const Facet facet = facet_at(plan, slopes.x + i, slopes.y + i);
    const Vector fresnel = on_curve<false>(plan.reflectance, cosine_of(facet)).value;
    const Vector weight = hn::IfThenElseZero(facet.lit, hn::Mul(hn::Mul(fresnel, facet.s), by_cosine));
    const Way way = way_of(plan, facet);
    const Place u = place_of(way.x, plan.bins_x), v = place_of(way.y, plan.bins_y);
    const Shares along_x = shares_of(u.t), along_y = shares_of(v.t);
    hn::StoreU(along_x.before, d, sent.x0.data() + i);
    hn::StoreU(along_x.middle, d, sent.x1.data() + i);
    hn::StoreU(along_x.after, d, sent.x2.data() + i);
    hn::StoreU(hn::Mul(weight, along_y.before), d, sent.y0.data() + i);
    hn::StoreU(hn::Mul(weight, along_y.middle), d, sent.y1.data() + i);
    hn::StoreU(hn::Mul(weight, along_y.after), d, sent.y2.data() + i);
    hn::StoreU(hn::Add(hn::Mul(v.bin, stride), u.bin), Integers(), sent.corner.data() + i);
  }
}

void receive(const Sent& sent, std::size_t count, std::size_t stride, double* light) {
  for (std::size_t i = 0; i < count; ++i) {
    double* const low = light + sent.corner[i];
    double* const middle = low + stride;
    double* const high = middle + stride;
    const double x0 = sent.x0[i], x1 = sent.x1[i], x2 = sent.x2[i];
    const double y0 = sent.y0[i], y1 = sent.y1[i], y2 = sent.y2[i];
    low[0] += y0 * x0;
    low[1] += y0 * x1;
    low[2] += y0 * x2;
    middle[0] += y1 * x0;
    middle[1] += y1 * x1;
    middle[2] += y1 * x2;
    high[0] += y2 * x0;
    high[1] += y2 * x1;
    high[2] += y2 * x2;
  }
}

// A function's value between the bins, and its slopes, a bin.
struct BinPoint {
  Vector value, along_x, along_y;
};
BinPoint between_bins(const double* framed, std::size_t stride, const Place& u, const Place& v) {
  const Doubles d;
  const auto wide = hn::Set(Integers(), static_cast<std::int32_t>(stride));
  const Index corner = hn::PromoteTo(Indices(), hn::Add(hn::Mul(v.bin, wide), u.bin));
  const Shares x = shares_of(u.t), y = shares_of(v.t);
  BinPoint point{hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  const auto add_line = [&](const double* line, Vector share, Vector slope) {
    const Vector before = hn::GatherIndex(d, line, corner), middle = hn::GatherIndex(d, line + 1, corner),
                 after = hn::GatherIndex(d, line + 2, corner);
    const auto sum = [&](Vector a, Vector b, Vector c) {
      return hn::Add(hn::Add(hn::Mul(a, before), hn::Mul(b, middle)), hn::Mul(c, after));
    };
    const Vector across = sum(x.before, x.middle, x.after);
    point.value = hn::Add(point.value, hn::Mul(share, across));
    point.along_x = hn::Add(point.along_x, hn::Mul(share, sum(x.slope_before, x.slope_middle, x.slope_after)));
    point.along_y = hn::Add(point.along_y, hn::Mul(slope, across));
  };
  add_line(framed, y.before, y.slope_before);
  add_line(framed + stride, y.middle, y.slope_middle);
  add_line(framed + 2 * stride, y.after, y.slope_after);
  return point;
}

// One slope of the weight: (F' ∂cosine s − F ω_i)/cosθ_i, with ∂cosine = −(ω_i + s p/n²)/n.
Vector weight_slope(const Facet& facet, const CurvePoint& fresnel, Vector along, Vector to_light) {
  const Vector turn = hn::Add(to_light, hn::Mul(hn::Mul(facet.s, along), facet.inverse_square));
  const Vector by_cosine = hn::Mul(hn::Mul(turn, hn::Sqrt(facet.inverse_square)), hn::Mul(fresnel.slope, facet.s));
  return hn::Neg(hn::Add(by_cosine, hn::Mul(fresnel.value, to_light)));
}

void derive(const LobePlan& plan, const FacetSlopes& slopes, const double* framed_values, float* toward_x,
            float* toward_y) {
  const Doubles d;
  const Vector ix = number(plan.to_light_x), iy = number(plan.to_light_y), by_cosine = number(1.0 / plan.to_light_z);
  const Vector half_x = number(0.5 * static_cast<double>(plan.bins_x)),
               half_y = number(0.5 * static_cast<double>(plan.bins_y)), two = number(2.0);
  for (std::size_t i = 0; i < slopes.count; i += hn::Lanes(d)) {
    const Facet facet = facet_at(plan, slopes.x + i, slopes.y + i);
    const CurvePoint fresnel = on_curve<true>(plan.reflectance, cosine_of(facet));
    const Way way = way_of(plan, facet);
    const BinPoint at =
        between_bins(framed_values, plan.framed_stride(), place_of(way.x, plan.bins_x), place_of(way.y, plan.bins_y));
    const Vector weight = hn::Mul(fresnel.value, facet.s);
    const Vector toward_u = hn::Mul(weight, hn::Mul(at.along_x, half_x)),
                 toward_v = hn::Mul(weight, hn::Mul(at.along_y, half_y));
    // ω_o = −k (p, q) − ω_i: toward p by 2/n² (ω_i,x + k p) (p, q) − (k, 0).
    const Vector along =
        hn::Mul(hn::Mul(two, facet.inverse_square), hn::Add(hn::Mul(facet.p, toward_u), hn::Mul(facet.q, toward_v)));
    const auto total = [&](Vector slope, Vector to_light, Vector toward) {
      const Vector moved =
          hn::Sub(hn::Mul(hn::Add(to_light, hn::Mul(facet.k, slope)), along), hn::Mul(facet.k, toward));
      const Vector sum = hn::Add(hn::Mul(weight_slope(facet, fresnel, slope, to_light), at.value), moved);
      return hn::DemoteTo(Floats(), hn::IfThenElseZero(facet.lit, hn::Mul(sum, by_cosine)));
    };
    hn::StoreU(total(facet.p, ix, toward_u), Floats(), toward_x + i);
    hn::StoreU(total(facet.q, iy, toward_v), Floats(), toward_y + i);
  }
}

// Visits chunk after chunk: visit(first point, its slopes). The last one comes from a room of its own, since vectors
// reach beyond its end.
template <class Visit>
void for_each_chunk(const FacetSlopes& slopes, const Visit& visit) {
  std::size_t first = 0;
  for (; first + chunk <= slopes.count; first += chunk) visit(first, {slopes.x + first, slopes.y + first, chunk});
  if (first == slopes.count) return;
  HWY_ALIGN std::array<float, chunk> x{}, y{};
  std::copy(slopes.x + first, slopes.x + slopes.count, x.begin());
  std::copy(slopes.y + first, slopes.y + slopes.count, y.begin());
  visit(first, {x.data(), y.data(), slopes.count - first});
}

}  // namespace

// By x − x, which is 0 for what is finite only.
bool finite(const float* values, std::size_t count) {
  const hn::ScalableTag<float> d;
  auto broken = hn::Zero(d);
  std::size_t i = 0;
  for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d)) {
    const auto some = hn::LoadU(d, values + i);
    broken = hn::Or(broken, hn::Sub(some, some));
  }
  bool all = hn::AllTrue(d, hn::Eq(broken, hn::Zero(d)));
  for (; i < count; ++i) all = all && std::isfinite(values[i]);
  return all;
}

void add_light(const LobePlan& plan, const FacetSlopes& slopes, double* framed_light) {
  Sent sent;
  for_each_chunk(slopes, [&](std::size_t, const FacetSlopes& some) {
    send(plan, some, sent);
    receive(sent, some.count, plan.framed_stride(), framed_light);
  });
}

void add_derivatives(const LobePlan& plan, const FacetSlopes& slopes, const double* framed_values, float* toward_x,
                     float* toward_y) {
  HWY_ALIGN std::array<float, chunk> x, y;
  for_each_chunk(slopes, [&](std::size_t first, const FacetSlopes& some) {
    derive(plan, some, framed_values, x.data(), y.data());
    for (std::size_t i = 0; i < some.count; ++i) {
      toward_x[first + i] += x[i];
      toward_y[first + i] += y[i];
    }
  });
}

}  // namespace mezzotint::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace mezzotint {

HWY_EXPORT(finite);
HWY_EXPORT(add_light);
HWY_EXPORT(add_derivatives);

bool all_finite(std::span<const float> values) { return HWY_DYNAMIC_DISPATCH(finite)(values.data(), values.size()); }

void add_facet_light(const LobePlan& plan, const FacetSlopes& slopes, double* framed_light) {
  HWY_DYNAMIC_DISPATCH(add_light)(plan, slopes, framed_light);
}

void add_facet_derivatives(const LobePlan& plan, const FacetSlopes& slopes, const double* framed_values,
                           float* toward_x, float* toward_y) {
  HWY_DYNAMIC_DISPATCH(add_derivatives)(plan, slopes, framed_values, toward_x, toward_y);
}

}  // namespace mezzotint

#endif
