#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace mezzotint {

/// How a cell of the noise lattice becomes random numbers.
enum class CellHash {
  Integer,  ///< every cell within ±2^20 has numbers of its own
  Slides    ///< the slides' linear q·(1, 1000, 576): repeats exactly at short lattice shifts
};

/// Sparse convolution noise of unit lattice and unit amplitude, about −0.9 … 0.9:
///
///     noise(p) = 4/(5·∛N) Σ over the 8 cells around p Σ_j α_j · (1 − 4 v·v)³,  v = x_j − p, v·v < ¼
///     α_j = rnd·(1 − 2 (j mod 2)),  N = 30 impulses a cell
///
/// Valid    |x|, |y|, |z| < 2^20.
/// Source   Frisvad 2019, slide "Noise"; Lewis, "Algorithms for solid noise synthesis", SIGGRAPH 1989.
[[nodiscard]] double sparse_noise(double x, double y, double z, std::uint64_t seed, CellHash hash = CellHash::Integer);

/// Means over a cell of noise² and of |∇noise|² in a plane (closed forms for N = 30), and the same on the
/// lattice plane z = 0, where the noise is not stationary.
inline constexpr double noise_variance = 0.02188;
inline constexpr double noise_plane_gradient_square = 0.8365;
inline constexpr double noise_variance_at_z0 = 0.02259;
inline constexpr double noise_plane_gradient_square_at_z0 = 0.8427;

/// A rectangle of the noise's lattice plane.
struct NoiseBounds {
  double x_low, x_high, y_low, y_high;
};

/// The same noise on one horizontal plane over a rectangle: the impulses are made once, so that a point costs
/// some tens of nanoseconds. Use this for anything that is more than a few points.
///
/// Errors   InvalidInput for bounds outside of ±2^20 or that hold more than 2^22 cells.
class NoisePlane {
public:
  NoisePlane(std::uint64_t seed, CellHash hash, double z, const NoiseBounds& bounds);

  /// noise(x, y, z); the point must lie within the bounds.
  [[nodiscard]] double operator()(double x, double y) const;

private:
  struct CellRange {
    std::size_t begin, end;
  };
  /// A cell's impulses are padded with weightless ones to whole groups of so many, for the vector unit.
  static constexpr std::size_t lanes = 8;

  void add_impulse(double x, double y, double headroom, double weight);
  [[nodiscard]] double cell_sum(const CellRange& cell, float px, float py) const;
  void gather_cell(std::uint64_t seed, CellHash hash, double z, std::int64_t column, std::int64_t row);

  std::int64_t first_column_ = 0, first_row_ = 0;
  std::size_t columns_ = 0, rows_ = 0;
  std::vector<CellRange> cells_;
  // Impulses cell after cell, as separate arrays so that the compiler can use whole vectors of them.
  std::vector<float> x_, y_;     ///< position relative to the cell's corner
  std::vector<float> headroom_;  ///< 1 − 4 (z_j − z)²
  std::vector<float> weight_;    ///< α_j
};

}  // namespace mezzotint
