#include "measurement/correction/convolution.h"

// One translation unit, compiled once for each instruction set; the best that the machine has is taken at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "measurement/correction/convolution.cpp"  // NOLINT
#include <hwy/foreach_target.h>                                      // IWYU pragma: keep
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace mezzotint::HWY_NAMESPACE {

namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Doubles = hn::ScalableTag<double>;

// Four rows at once, so that each value that is loaded serves four sums; two vectors of columns.
void four_rows(const double* in, std::size_t columns, const double* weights, std::size_t taps, double* out) {
  const Doubles d;
  const std::size_t lanes = hn::Lanes(d);
  auto a0 = hn::Zero(d), a1 = a0, a2 = a0, a3 = a0, b0 = a0, b1 = a0, b2 = a0, b3 = a0;
  for (std::size_t k = 0; k < taps + 3; ++k) {
    const auto a = hn::LoadU(d, in + k * columns), b = hn::LoadU(d, in + k * columns + lanes);
    const auto weight = [&](std::size_t row) {
      return hn::Set(d, k >= row && k - row < taps ? weights[k - row] : 0.0);
    };
    const auto w0 = weight(0), w1 = weight(1), w2 = weight(2), w3 = weight(3);
    a0 = hn::MulAdd(w0, a, a0);
    b0 = hn::MulAdd(w0, b, b0);
    a1 = hn::MulAdd(w1, a, a1);
    b1 = hn::MulAdd(w1, b, b1);
    a2 = hn::MulAdd(w2, a, a2);
    b2 = hn::MulAdd(w2, b, b2);
    a3 = hn::MulAdd(w3, a, a3);
    b3 = hn::MulAdd(w3, b, b3);
  }
  hn::StoreU(a0, d, out);
  hn::StoreU(b0, d, out + lanes);
  hn::StoreU(a1, d, out + columns);
  hn::StoreU(b1, d, out + columns + lanes);
  hn::StoreU(a2, d, out + 2 * columns);
  hn::StoreU(b2, d, out + 2 * columns + lanes);
  hn::StoreU(a3, d, out + 3 * columns);
  hn::StoreU(b3, d, out + 3 * columns + lanes);
}

void convolve(const double* in, std::size_t rows, std::size_t columns, const double* weights, std::size_t taps,
              double* out) {
  const std::size_t step = 2 * hn::Lanes(Doubles()), whole_rows = rows / 4 * 4, whole_columns = columns / step * step;
  for (std::size_t c = 0; c < whole_columns; c += step)
    for (std::size_t r = 0; r < whole_rows; r += 4)
      four_rows(in + r * columns + c, columns, weights, taps, out + r * columns + c);
  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t c = r < whole_rows ? whole_columns : 0; c < columns; ++c) {
      double sum = 0.0;
      for (std::size_t k = 0; k < taps; ++k) sum += weights[k] * in[(r + k) * columns + c];
      out[r * columns + c] = sum;
    }
}

}  // namespace

}  // namespace mezzotint::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace mezzotint {

HWY_EXPORT(convolve);

void convolve_columns(const double* in, std::size_t rows, std::size_t columns, const double* weights, std::size_t taps,
                      double* out) {
  HWY_DYNAMIC_DISPATCH(convolve)(in, rows, columns, weights, taps, out);
}

}  // namespace mezzotint

#endif
