#pragma once

#include <cstdint>

namespace mezzotint {

/// What arrived in a bin, by the weights of the paths. Where paths correct a splat, some of them take light away.
struct BinHits {
  double sum = 0.0;       ///< Σw
  double squares = 0.0;   ///< Σw²
  double negative = 0.0;  ///< Σ|w| of those below 0

  /// So many hits of equal weight would know the sum of |w| as well: (Σ|w|)²/Σw².
  [[nodiscard]] double effective() const;
};

/// From below this many effective hits on, the spread between batches says less about a bin than their number does.
inline constexpr double few_hits = 10.0;

/// A 95 % interval.
struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// The interval of Σw's expectation in a bin of few hits: that of Garwood for a Poisson number, taken for the effective
/// hits and scaled by their weight, so that it covers 95 % or more; light that came and light that was taken away have
/// an interval each, joined by their distances. Where nothing has arrived the upper end is 3.69 of `largest_weight`.
/// Source   F. Garwood, "Fiducial limits for the Poisson distribution", Biometrika 28 (1936); effective hits: Fay &
///          Feuer, Statistics in Medicine 16 (1997); difference: Zou & Donner, Statistics in Medicine 27 (2008).
[[nodiscard]] Interval few_hits_interval(const BinHits& hits, double largest_weight);

/// x of P(χ² < x) = p with any positive number of degrees of freedom, to 1e-9 of it.
[[nodiscard]] double chi_square_quantile(double p, double degrees);
/// t of P(|T| < t) = 0.95 with so many degrees of freedom; to 1e-3 from 3 on (Abramowitz & Stegun 26.7.5).
[[nodiscard]] double student_95(std::uint32_t degrees);

}  // namespace mezzotint
