#include "inverse/objective/lobe_kernels.h"

// One translation unit, compiled once for each instruction set; the best that the machine has is taken at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "inverse/objective/lobe_kernels.cpp"  // NOLINT
#include <hwy/foreach_target.h>                                  // IWYU pragma: keep
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <hwy/aligned_allocator.h>

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

HWY_INLINE Vector number(double value) { return hn::Set(Doubles(), value); }

// 1/√x: in single precision, then by one step of Newton's method to 3e-14; 0 beyond what a float holds.
HWY_INLINE Vector inverse_root(Vector x) {
  const Floats f;
  const auto root = hn::Div(hn::Set(f, 1.0F), hn::Sqrt(hn::DemoteTo(f, x)));
  const Vector guess = hn::PromoteTo(Doubles(), root);
  const Vector off = hn::Mul(hn::Mul(hn::Mul(number(0.5), x), guess), guess);
  return hn::Mul(guess, hn::Sub(number(1.5), off));
}

// A facet with slopes p, q as the light meets it: s = n·(ω_i·m) and k = 2 s/n², both 0 where it is turned away from the
// light or sends it downward.
struct Facet {
  Vector p, q, inverse_n, s, k;
};
HWY_INLINE Facet facet_at(const LobePlan& plan, const float* slopes_x, const float* slopes_y) {
  const Doubles d;
  const Vector p = hn::PromoteTo(d, hn::LoadU(Floats(), slopes_x));
  const Vector q = hn::PromoteTo(d, hn::LoadU(Floats(), slopes_y));
  const Vector n = inverse_root(hn::Add(hn::Add(number(1.0), hn::Mul(p, p)), hn::Mul(q, q)));
  const Vector s = hn::Sub(hn::Sub(number(plan.to_light_z), hn::Mul(p, number(plan.to_light_x))),
                           hn::Mul(q, number(plan.to_light_y)));
  const Vector k = hn::Mul(hn::Mul(number(2.0), s), hn::Mul(n, n));
  const auto lit = hn::Gt(k, number(plan.to_light_z));  // s is positive then
  return {p, q, n, hn::IfThenElseZero(lit, s), hn::IfThenElseZero(lit, k)};
}

// Value and slope of a curve, at x from 0 to 1 and a rounding more.
struct CurvePoint {
  Vector value, slope;
};
template <bool with_slope>
HWY_INLINE CurvePoint on_curve(const CurveCells& curve, Vector x) {
  const Doubles d;
  const auto steps = static_cast<double>(curve.steps);
  const Vector at = hn::Mul(x, number(steps));
  const auto cell = hn::DemoteTo(Integers(), at);
  const Vector t = hn::Sub(at, hn::PromoteTo(d, cell));
  const Index first = hn::ShiftLeft<2>(hn::PromoteTo(Indices(), cell));
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

// The nearest bin along one axis, and how far from its lower edge.
struct Place {
  hn::Vec<Integers> bin;
  Vector within;
};
// Of −k·slope − ω_i, from −1 to 1: what is below by a rounding is cut to the first bin by the conversion.
HWY_INLINE Place place_of(Vector k, Vector slope, double to_light, std::size_t bins) {
  const double half = 0.5 * static_cast<double>(bins);
  const Vector coordinate = hn::Sub(number(half * (1.0 - to_light)), hn::Mul(hn::Mul(k, number(half)), slope));
  const auto last = hn::Set(Integers(), static_cast<std::int32_t>(bins) - 1);
  const auto bin = hn::Min(hn::DemoteTo(Integers(), coordinate), last);
  return {bin, hn::Sub(coordinate, hn::PromoteTo(Doubles(), bin))};
}

// The shares of three bins and their slopes, as soft_bins.
struct Shares {
  Vector before, middle, after, slope_before, slope_middle, slope_after;
};
HWY_INLINE Shares shares_of(Vector within) {
  const Vector half = number(0.5), low = hn::Sub(number(1.0), within), t = hn::Sub(within, half);
  return {hn::Mul(half, hn::Mul(low, low)),
          hn::Sub(number(0.75), hn::Mul(t, t)),
          hn::Mul(half, hn::Mul(within, within)),
          hn::Neg(low),
          hn::Mul(number(-2.0), t),
          within};
}

// Bins that are added to four at a time, in one copy for each remainder of the first bin's column by four: what
// neighbouring facets add to overlaps wholly or not at all, so that the processor need not wait for the one before.
struct Banks {
  static constexpr std::size_t width = 4;

  std::size_t stride, size;
  hwy::AlignedFreeUniquePtr<double[]> light;

  explicit Banks(const LobePlan& plan)
      : stride((plan.bins_x + width - 1) / width * width),
        size(stride * (plan.bins_y + 2)),
        light(hwy::AllocateAligned<double>(width * size)) {
    std::fill_n(light.get(), width * size, 0.0);
  }
  void add_to(const LobePlan& plan, double* framed_light) const {
    for (std::size_t bank = 0; bank < width; ++bank) {
      const std::size_t columns = std::min(stride, plan.framed_stride() - bank);
      for (std::size_t row = 0; row < plan.bins_y + 2; ++row) {
        const double* const from = light.get() + bank * size + row * stride;
        double* const to = framed_light + row * plan.framed_stride() + bank;
        for (std::size_t column = 0; column < columns; ++column) to[column] += from[column];
      }
    }
  }
};

// The light of a chunk: four shares along x (the last is 0), those along y times the weight, and the first bin.
struct Sent {
  HWY_ALIGN std::array<double, Banks::width * chunk> x;
  HWY_ALIGN std::array<double, chunk> y0, y1, y2;
  HWY_ALIGN std::array<std::int32_t, chunk> corner;
};

void send(const LobePlan& plan, const Banks& banks, const FacetSlopes& slopes, Sent& sent) {
  const Doubles d;
  const Integers integers;
  const auto stride = hn::Set(integers, static_cast<std::int32_t>(banks.stride)),
             to_next_bank = hn::Set(integers, static_cast<std::int32_t>(banks.size) - 1);
  const Vector by_cosine = number(1.0 / plan.to_light_z);
  for (std::size_t i = 0; i < slopes.count; i += hn::Lanes(d)) {
    const Facet facet = facet_at(plan, slopes.x + i, slopes.y + i);
    const Vector fresnel = on_curve<false>(plan.reflectance, hn::Mul(facet.s, facet.inverse_n)).value;
    const Vector weight = hn::Mul(hn::Mul(fresnel, facet.s), by_cosine);
    const Place u = place_of(facet.k, facet.p, plan.to_light_x, plan.bins_x);
    const Place v = place_of(facet.k, facet.q, plan.to_light_y, plan.bins_y);
    const Shares along_x = shares_of(u.within), along_y = shares_of(v.within);
    hn::StoreInterleaved4(along_x.before, along_x.middle, along_x.after, hn::Zero(d), d,
                          sent.x.data() + Banks::width * i);
    hn::StoreU(hn::Mul(weight, along_y.before), d, sent.y0.data() + i);
    hn::StoreU(hn::Mul(weight, along_y.middle), d, sent.y1.data() + i);
    hn::StoreU(hn::Mul(weight, along_y.after), d, sent.y2.data() + i);
    const auto corner = hn::Add(hn::Mul(v.bin, stride), u.bin);
    const auto bank = hn::And(corner, hn::Set(integers, Banks::width - 1));
    hn::StoreU(hn::Add(corner, hn::Mul(bank, to_next_bank)), integers, sent.corner.data() + i);
  }
}

void receive(const Sent& sent, std::size_t count, const Banks& banks) {
  const hn::CappedTag<double, Banks::width> d;
  const auto add_line = [&](double* line, const double* shares, double weight) {
    const auto factor = hn::Set(d, weight);
    for (std::size_t k = 0; k < Banks::width; k += hn::Lanes(d))
      hn::Store(hn::Add(hn::Load(d, line + k), hn::Mul(factor, hn::Load(d, shares + k))), d, line + k);
  };
  double* const light = banks.light.get();
  for (std::size_t i = 0; i < count; ++i) {
    double* const line = light + sent.corner[i];
    const double* const shares = sent.x.data() + Banks::width * i;
    add_line(line, shares, sent.y0[i]);
    add_line(line + banks.stride, shares, sent.y1[i]);
    add_line(line + 2 * banks.stride, shares, sent.y2[i]);
  }
}

// A function's value between the bins, and its slopes, a bin.
struct BinPoint {
  Vector value, along_x, along_y;
};
HWY_INLINE BinPoint between_bins(const double* framed, std::size_t stride, const Place& u, const Place& v) {
  const Doubles d;
  const auto wide = hn::Set(Integers(), static_cast<std::int32_t>(stride));
  const Index corner = hn::PromoteTo(Indices(), hn::Add(hn::Mul(v.bin, wide), u.bin));
  const Shares x = shares_of(u.within), y = shares_of(v.within);
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
HWY_INLINE Vector weight_slope(const Facet& facet, const CurvePoint& fresnel, Vector along, Vector to_light) {
  const Vector inverse_square = hn::Mul(facet.inverse_n, facet.inverse_n);
  const Vector turn = hn::Add(to_light, hn::Mul(hn::Mul(facet.s, along), inverse_square));
  const Vector by_cosine = hn::Mul(hn::Mul(turn, facet.inverse_n), hn::Mul(fresnel.slope, facet.s));
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
    const CurvePoint fresnel = on_curve<true>(plan.reflectance, hn::Mul(facet.s, facet.inverse_n));
    const BinPoint at =
        between_bins(framed_values, plan.framed_stride(), place_of(facet.k, facet.p, plan.to_light_x, plan.bins_x),
                     place_of(facet.k, facet.q, plan.to_light_y, plan.bins_y));
    // By cosθ_i only where there is light: a facet that sends none has no slope.
    const Vector per_cosine = hn::IfThenElseZero(hn::Gt(facet.s, hn::Zero(d)), by_cosine);
    const Vector weight = hn::Mul(fresnel.value, facet.s);
    const Vector toward_u = hn::Mul(weight, hn::Mul(at.along_x, half_x)),
                 toward_v = hn::Mul(weight, hn::Mul(at.along_y, half_y));
    // ω_o = −k (p, q) − ω_i: toward p by 2/n² (ω_i,x + k p) (p, q) − (k, 0).
    const Vector along = hn::Mul(hn::Mul(two, hn::Mul(facet.inverse_n, facet.inverse_n)),
                                 hn::Add(hn::Mul(facet.p, toward_u), hn::Mul(facet.q, toward_v)));
    const auto total = [&](Vector slope, Vector to_light, Vector toward) {
      const Vector moved =
          hn::Sub(hn::Mul(hn::Add(to_light, hn::Mul(facet.k, slope)), along), hn::Mul(facet.k, toward));
      const Vector sum = hn::Add(hn::Mul(weight_slope(facet, fresnel, slope, to_light), at.value), moved);
      return hn::DemoteTo(Floats(), hn::Mul(sum, per_cosine));
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
  const Banks banks(plan);
  Sent sent;
  for_each_chunk(slopes, [&](std::size_t, const FacetSlopes& some) {
    send(plan, banks, some, sent);
    receive(sent, some.count, banks);
  });
  banks.add_to(plan, framed_light);
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
