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

// What a row of samples takes from an impulse: with t = first, first + 1, …
struct Chord {
  std::size_t count;
  float first, top, fall, weight;
  float lean, rows;  ///< columns from the impulse are t + lean
};

// Sums of one row from the chord's first sample on.
struct RowSums {
  float *values, *columns, *rows;
};

// Nothing is fused, each t is rounded once and nothing is added beyond the count, so that every width of vector gives
// the same bits.
template <bool WithGradient>
void add_chord(const RowSums& sums, const Chord& chord) {
  const Floats d;
  const auto from = hn::Set(d, chord.first), peak = hn::Set(d, chord.top), steepness = hn::Set(d, chord.fall),
             factor = hn::Set(d, chord.weight), lean = hn::Set(d, chord.lean), rows = hn::Set(d, chord.rows);
  const auto step = hn::Set(d, static_cast<float>(hn::Lanes(d)));
  auto index = hn::Iota(d, 0.0F);
  const auto add = [&](float* at, auto term) { hn::StoreU(hn::Add(hn::LoadU(d, at), term), d, at); };
  const auto add_at = [&](std::size_t i, const auto& inside) {
    const auto t = hn::Add(from, index);
    const auto falloff = hn::Max(hn::Zero(d), hn::Sub(peak, hn::Mul(steepness, hn::Mul(t, t))));
    const auto square = hn::Mul(falloff, falloff);
    add(sums.values + i, inside(hn::Mul(factor, hn::Mul(falloff, square))));
    if constexpr (WithGradient) {
      const auto slope = hn::Mul(factor, square);
      add(sums.columns + i, inside(hn::Mul(slope, hn::Add(t, lean))));
      add(sums.rows + i, inside(hn::Mul(slope, rows)));
    }
  };
  std::size_t i = 0;
  for (; i + hn::Lanes(d) <= chord.count; i += hn::Lanes(d), index = hn::Add(index, step)) {
    add_at(i, [](auto term) { return term; });
  }
  if (i == chord.count) return;
  const auto rest = hn::FirstN(d, chord.count - i);
  add_at(i, [rest](auto term) { return hn::IfThenElseZero(rest, term); });
}

template <bool WithGradient>
void splat_all(const PlaneImpulses& impulses, const SampleRows& rows, const SplatSums& sums) {
  const double last_column = static_cast<double>(rows.columns) - 1.0, last_row = static_cast<double>(rows.rows) - 1.0;
  for (std::size_t j = 0; j < impulses.count; ++j) {
    const double at_row = impulses.row[j], at_column = impulses.column[j], headroom = impulses.headroom[j];
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
      const std::size_t first = row * rows.stride + static_cast<std::size_t>(begin);
      const auto from = [first](float* all) { return all != nullptr ? all + first : nullptr; };
      add_chord<WithGradient>(
          {sums.values + first, from(sums.columns), from(sums.rows)},
          {static_cast<std::size_t>(end - begin) + 1, static_cast<float>(begin - middle), static_cast<float>(top),
           static_cast<float>(rows.fall), static_cast<float>(impulses.weight[j]), static_cast<float>(rows.lean * s),
           static_cast<float>(s)});
    }
  }
}

void splat(const PlaneImpulses& impulses, const SampleRows& rows, const SplatSums& sums) {
  sums.columns != nullptr ? splat_all<true>(impulses, rows, sums) : splat_all<false>(impulses, rows, sums);
}

}  // namespace mezzotint::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace mezzotint {

HWY_EXPORT(splat);

void splat_impulses(const PlaneImpulses& impulses, const SampleRows& rows, const SplatSums& sums) {
  HWY_DYNAMIC_DISPATCH(splat)(impulses, rows, sums);
}

}  // namespace mezzotint

#endif
