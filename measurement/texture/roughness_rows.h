#pragma once

#include <cstddef>
#include <span>

/// Inside of measurement/texture: sums over a stretch of a row, with the vectors that the machine has. Missing samples
/// are left out; the order of the sums depends on the width of the vectors, on nothing else.

namespace mezzotint {

/// Sums over a set of samples of powers of the height above a reference.
struct PowerSums {
  double count = 0.0, first = 0.0, second = 0.0, third = 0.0, fourth = 0.0;

  PowerSums& operator+=(const PowerSums& other) {
    count += other.count;
    first += other.first;
    second += other.second;
    third += other.third;
    fourth += other.fourth;
    return *this;
  }
  [[nodiscard]] PowerSums without(const PowerSums& part) const {
    return {count - part.count, first - part.first, second - part.second, third - part.third, fourth - part.fourth};
  }
};
[[nodiscard]] PowerSums power_sums(std::span<const float> heights_um, double reference_um);

/// Adds Σ |z − reference| for each of the references, of which there are 17.
inline constexpr std::size_t reference_count = 17;
void add_deviations(std::span<const float> heights_um, std::span<const double, reference_count> references_um,
                    std::span<double, reference_count> sums_um);

/// Sums over the triangles of whole cells.
struct SlopeSums {
  double count = 0.0, squares = 0.0, area_excess = 0.0;

  SlopeSums& operator+=(const SlopeSums& other) {
    count += other.count;
    squares += other.squares;
    area_excess += other.area_excess;
    return *this;
  }
  [[nodiscard]] SlopeSums without(const SlopeSums& part) const {
    return {count - part.count, squares - part.squares, area_excess - part.area_excess};
  }
};
/// The two triangles a cell of `to_mesh`, of the cells between two rows of as many samples each: one fewer.
[[nodiscard]] SlopeSums slope_sums(std::span<const float> row_um, std::span<const float> next_row_um, double per_x,
                                   double per_y);

}  // namespace mezzotint
