#include "forward/process/row_blend.h"

// One translation unit, compiled once for each instruction set; the best that the machine has is taken at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "forward/process/row_blend.cpp"  // NOLINT
#include <hwy/foreach_target.h>                             // IWYU pragma: keep
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace mezzotint::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// The first row, then two by two; nothing is fused.
template <class Tag>
HWY_INLINE void blend_at(Tag d, const WeightedRow* rows, std::size_t row_count, std::size_t i, float* out) {
  const auto term = [&](const WeightedRow& row) {
    return hn::Mul(hn::Set(d, row.weight), hn::LoadU(d, row.values + i));
  };
  auto sum = term(rows[0]);
  std::size_t k = 1;
  for (; k + 1 < row_count; k += 2) sum = hn::Add(sum, hn::Add(term(rows[k]), term(rows[k + 1])));
  if (k < row_count) sum = hn::Add(sum, term(rows[k]));
  hn::StoreU(sum, d, out + i);
}

void blend_rows(const WeightedRow* rows, std::size_t row_count, std::size_t count, float* out) {
  const hn::ScalableTag<float> d;
  std::size_t i = 0;
  for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d)) blend_at(d, rows, row_count, i, out);
  for (; i < count; ++i) blend_at(hn::CappedTag<float, 1>(), rows, row_count, i, out);
}

}  // namespace mezzotint::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include <algorithm>

namespace mezzotint {

HWY_EXPORT(blend_rows);

void blend(std::span<const WeightedRow> rows, std::size_t count, float* out) {
  if (rows.empty()) {
    std::fill_n(out, count, 0.0F);
    return;
  }
  HWY_DYNAMIC_DISPATCH(blend_rows)(rows.data(), rows.size(), count, out);
}

}  // namespace mezzotint

#endif
