#include "forward/pattern/impulse_splat.h"

// One translation unit, compiled once for each instruction set; the best that the machine has is taken at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "forward/pattern/impulse_splat.cpp"  // NOLINT
#include <hwy/foreach_target.h>                                 // IWYU pragma: keep
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace mezzotint::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, widest_vector>;

constexpr double widest_boxed = 40.0;

// Adds weight · max(0, top − fall·t²)³ for t = first, first + 1, … Nothing is fused, each t is rounded once and nothing
// is added beyond the count, so that every width of vector gives the same bits.
void add_chord(float* row, std::size_t count, float first, float top, float fall, float weight) {
  const Floats d;
  const auto from = hn::Set(d, first), peak = hn::Set(d, top), steepness = hn::Set(d, fall),
             factor = hn::Set(d, weight);
  const auto step = hn::Set(d, static_cast<float>(hn::Lanes(d)));
  auto index = hn::Iota(d, 0.0F);
  const auto term = [&](auto i) {
    const auto t = hn::Add(from, i);
    const auto falloff = hn::Max(hn::Zero(d), hn::Sub(peak, hn::Mul(steepness, hn::Mul(t, t))));
    return hn::Mul(factor, hn::Mul(falloff, hn::Mul(falloff, falloff)));
  };
  std::size_t i = 0;
  for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d), index = hn::Add(index, step)) {
    hn::StoreU(hn::Add(hn::LoadU(d, row + i), term(index)), d, row + i);
  }
  if (i == count) return;
  const auto inside = hn::FirstN(d, count - i);
  hn::StoreU(hn::Add(hn::LoadU(d, row + i), hn::IfThenElseZero(inside, term(index))), d, row + i);
}

void splat(const PlaneImpulses& impulses, const SampleRows& rows, float* sums) {
  const double last_column = static_cast<double>(rows.columns) - 1.0, last_row = static_cast<double>(rows.rows) - 1.0;
  const auto fall = static_cast<float>(rows.fall);
  for (std::size_t j = 0; j < impulses.count; ++j) {
    const double at_row = impulses.row[j], at_column = impulses.column[j], headroom = impulses.headroom[j];
    const auto weight = static_cast<float>(impulses.weight[j]);
    const double reach = std::sqrt(headroom / rows.row_fall), widest = std::sqrt(headroom / rows.fall);
    const double low = std::max(std::ceil(at_row - reach), 0.0), high = std::min(std::floor(at_row + reach), last_row);
    if (low > high) continue;
    for (auto row = static_cast<std::size_t>(low); row <= static_cast<std::size_t>(high); ++row) {
      const double s = static_cast<double>(row) - at_row, top = headroom - rows.row_fall * s * s,
                   middle = at_column + rows.lean * s;
      // A narrow impulse takes all of its rows as wide as the widest: loops of one length are foreseen.
      const double half = widest < widest_boxed ? widest : std::sqrt(std::max(0.0, top / rows.fall));
      const double begin = std::max(std::ceil(middle - half), 0.0);
      const double end = std::min(std::floor(middle + half), last_column);
      if (begin > end) continue;
      add_chord(sums + row * rows.stride + static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin) + 1,
                static_cast<float>(begin - middle), static_cast<float>(top), fall, weight);
    }
  }
}

}  // namespace mezzotint::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace mezzotint {

HWY_EXPORT(splat);

void splat_impulses(const PlaneImpulses& impulses, const SampleRows& rows, float* sums) {
  HWY_DYNAMIC_DISPATCH(splat)(impulses, rows, sums);
}

}  // namespace mezzotint

#endif
