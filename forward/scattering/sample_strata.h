#pragma once

#include <cstdint>
#include <utility>

namespace mezzotint {

/// Strata of the unit square, numbered along a Morton curve so that neighbours in number are neighbours in
/// place (random order costs a tracer 3–5 times the time).
///
/// Shape    2^bits strata: 2^⌈bits/2⌉ along u, 2^⌊bits/2⌋ along v.
class SampleStrata {
public:
  explicit SampleStrata(std::uint32_t bits);
  /// The point of stratum `index` at (jitter_u, jitter_v) in [0, 1)².
  [[nodiscard]] std::pair<double, double> point(std::uint64_t index, double jitter_u, double jitter_v) const;

private:
  double width_;
  double height_;
};

}  // namespace mezzotint
