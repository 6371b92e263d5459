#include "measurement/instrument/holes.h"

#include <cmath>
#include <numbers>

namespace mezzotint {

// A hole's share of its cell is π/4.
Holes::Holes(double share, Length diameter, std::uint64_t seed)
    : diameter_um_(diameter.um()),
      none_in_a_cell_(std::pow(1.0 - share, 4.0 / std::numbers::pi)),
      mean_in_a_cell_(-std::log(none_in_a_cell_)),
      random_(seed, RandomPurpose::InstrumentHole) {}

bool Holes::cover(FieldPoint point) const {
  if (mean_in_a_cell_ == 0.0) return false;
  // In diameters, from a row and a column of cells before the first.
  const double x = point.x_um / diameter_um_ + 1.0, y = point.y_um / diameter_um_ + 1.0;
  const auto column = static_cast<std::uint64_t>(x), row = static_cast<std::uint64_t>(y);
  for (std::uint64_t r = row - 1; r <= row + 1; ++r)
    for (std::uint64_t c = column - 1; c <= column + 1; ++c)
      if (cell_covers(c, r, x, y)) return true;
  return false;
}

bool Holes::cell_covers(std::uint64_t column, std::uint64_t row, double x, double y) const {
  const std::uint64_t index = row << 32U | column;
  // How many centres: a Poisson number by inversion.
  const double at = random_.uniform4(index, 0)[0];
  double probability = none_in_a_cell_, sum = probability;
  for (std::uint32_t k = 1; at >= sum && probability > 0.0; ++k) {
    const auto place = random_.uniform4(index, k);
    const double dx = static_cast<double>(column) + place[0] - x, dy = static_cast<double>(row) + place[1] - y;
    if (dx * dx + dy * dy <= 0.25) return true;
    probability *= mean_in_a_cell_ / k;
    sum += probability;
  }
  return false;
}

}  // namespace mezzotint
