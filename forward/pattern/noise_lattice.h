#pragma once

#include <array>
#include <cstdint>

#include "forward/pattern/pattern_map.h"

/// Inside of forward/pattern, and for forward/process.

namespace mezzotint {

/// How a cell of the noise lattice becomes random numbers.
enum class CellHash {
  Integer,  ///< every cell within ±2^20 has numbers of its own
  Slides    ///< the slides' linear q·(1, 1000, 576): repeats exactly at short lattice shifts
};

/// The impulses of sparse convolution noise in one cell.
struct CellImpulses {
  static constexpr std::size_t count = 30;
  static constexpr std::size_t room = 32;  ///< for whole vectors; what lies beyond `count` means nothing

  alignas(64) std::array<double, room> x, y, z;  ///< within the cell, in [0, 1)
  alignas(64) std::array<double, room> weight;   ///< α = rnd·(1 − 2 (j mod 2)), in (−1, 1)
};

/// The random impulses in the cells of the noise's lattice: each a pure function of seed, cell and number.
///
/// Source   Frisvad 2019, slide "Noise".
class NoiseLattice {
public:
  /// Coordinates must be smaller than this in absolute value.
  static constexpr double largest_coordinate = 1048576.0;

  NoiseLattice(std::uint64_t seed, CellHash hash) : seed_(seed), hash_(hash) {}
  /// The lattice that repeats with the sheet's tile, if the sheet is periodic; `map` is fitted to it.
  NoiseLattice(std::uint64_t seed, CellHash hash, const PatternMap& map, const Sheet& sheet);

  void impulses(std::int64_t x, std::int64_t y, std::int64_t z, CellImpulses& into) const;

private:
  std::uint64_t seed_;
  CellHash hash_;
  // The periods (step_x, 0) and (shear, step_y), in cells; 0 for none.
  std::int64_t step_x_ = 0, shear_ = 0, step_y_ = 0;
};

/// The impulses of the cell with that index: those of RandomStream(seed, PatternImpulse) at (index, j), many at once
/// (noise_impulses.cpp).
void draw_impulses(std::uint64_t seed, std::uint64_t index, CellImpulses& into);

/// 4/(5·∛N): what the sum over the impulses is multiplied by.
[[nodiscard]] double noise_normalisation();

}  // namespace mezzotint
