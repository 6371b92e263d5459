#pragma once

#include <cstdint>
#include <span>

namespace mezzotint {

/// Where in its stratum a sample lies.
enum class Placement : std::uint8_t {
  Strata,   ///< anywhere, independently: jittered strata
  Lattice,  ///< at the same place in all strata of a batch: a shifted lattice (aliases with periodic patterns)
  Random    ///< anywhere in the whole square, in no order: for comparison only
};

/// Points of the unit square, one a stratum, numbered along a Morton curve so that neighbours in number are
/// neighbours in place (random order costs a tracer 3–5 times the time).
///
/// Shape    2^bits strata: 2^⌈bits/2⌉ along u, 2^⌊bits/2⌋ along v.
/// Bits     a function of (seed, pass, batch, index) alone.
/// Source   jitter by the integer hash "lowbias32" (C. Wellons, "Prospecting for hash functions", 2018), keyed by
///          Philox; Morton order: G. M. Morton 1966.
class SampleStrata {
public:
  SampleStrata(std::uint32_t bits, Placement placement, std::uint64_t seed, std::uint32_t pass, std::uint32_t batch);
  /// Fills u and v with the points of strata first, first + 1, …
  void points(std::uint64_t first, std::span<double> u, std::span<double> v) const;
  /// The same number of strata along u alone; v is anywhere.
  void points_on_line(std::uint64_t first, std::span<double> u, std::span<double> v) const;

private:
  void fill_block(std::uint64_t first, std::span<double> u, std::span<double> v) const;

  Placement placement_;
  double width_, height_;
  std::uint32_t key_u_, key_v_;
  double shift_u_, shift_v_;
};

}  // namespace mezzotint
