#include "forward/pattern/noise_lattice.h"

// One translation unit, compiled once for each instruction set; the best that the machine has is taken at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "forward/pattern/noise_impulses.cpp"  // NOLINT
#include <hwy/foreach_target.h>                                  // IWYU pragma: keep
#include <hwy/highway.h>

#include "forward/base/random.h"

HWY_BEFORE_NAMESPACE();
namespace mezzotint::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Words = hn::CappedTag<std::uint64_t, 8>;
using Doubles = hn::CappedTag<double, 8>;

// The full product of the low halves.
template <typename V>
V product(V a, V b) {
#if HWY_TARGET == HWY_SCALAR
  const auto low = [](V word) { return hn::GetLane(word) & 0xFFFFFFFFU; };
  return hn::Set(Words(), low(a) * low(b));
#else
  const hn::Repartition<std::uint32_t, Words> halves;
  return hn::MulEven(hn::BitCast(halves, a), hn::BitCast(halves, b));
#endif
}

// Philox4x32-10 (Salmon et al. 2011) on words in the low halves of 64 bits. The high halves hold what the products
// left there, which no product reads.
template <typename V>
void philox(V& a, V& b, V& c, V& d, std::uint64_t seed) {
  const Words words;
  const auto first = hn::Set(words, 0xD2511F53U), second = hn::Set(words, 0xCD9E8D57U);
  auto key = static_cast<std::uint32_t>(seed), other_key = static_cast<std::uint32_t>(seed >> 32U);
  for (int round = 0; round < 10; ++round) {
    const auto p = product(first, a), q = product(second, c);
    a = hn::Xor(hn::Xor(hn::ShiftRight<32>(q), b), hn::Set(words, key));
    c = hn::Xor(hn::Xor(hn::ShiftRight<32>(p), d), hn::Set(words, other_key));
    b = q;
    d = p;
    key += 0x9E3779B9U;
    other_key += 0xBB67AE85U;
  }
}

// A word as a number in [0, 1): exact, by way of the mantissa of 2^52 + word.
template <typename V>
auto unit_interval(V word) {
  const Words words;
  const Doubles doubles;
  const auto bits = hn::Or(hn::And(word, hn::Set(words, 0xFFFFFFFFU)), hn::Set(words, 0x4330000000000000U));
  return hn::Mul(hn::Sub(hn::BitCast(doubles, bits), hn::Set(doubles, 4503599627370496.0)),
                 hn::Set(doubles, 1.0 / 4294967296.0));
}

void draw(std::uint64_t seed, std::uint64_t index, CellImpulses& into) {
  const Words words;
  const Doubles doubles;
  for (std::size_t j = 0; j < CellImpulses::room; j += hn::Lanes(words)) {
    const auto number = hn::Iota(words, j);
    auto a = hn::Set(words, index & 0xFFFFFFFFU), b = hn::Set(words, index >> 32U), c = number;
    auto d = hn::Set(words, static_cast<std::uint64_t>(RandomPurpose::PatternImpulse));
    philox(a, b, c, d, seed);
    // Every second impulse is negative: its number's last bit becomes the sign.
    const auto sign = hn::BitCast(doubles, hn::ShiftLeft<63>(number));
    hn::StoreU(unit_interval(a), doubles, &into.x[j]);
    hn::StoreU(unit_interval(b), doubles, &into.y[j]);
    hn::StoreU(unit_interval(c), doubles, &into.z[j]);
    hn::StoreU(hn::Xor(unit_interval(d), sign), doubles, &into.weight[j]);
  }
}

}  // namespace mezzotint::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace mezzotint {

HWY_EXPORT(draw);

void draw_impulses(std::uint64_t seed, std::uint64_t index, CellImpulses& into) {
  HWY_DYNAMIC_DISPATCH(draw)(seed, index, into);
}

}  // namespace mezzotint

#endif
