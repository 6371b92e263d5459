#pragma once

#include <cstdint>

#include "forward/base/random.h"
#include "forward/base/units.h"
#include "forward/surface/resample.h"

/// Inside of measurement/instrument.

namespace mezzotint {

/// Round holes scattered over a plane, independent of each other (they may overlap): what dust, or a drop of resin,
/// takes from an instrument.
///
/// How      Boolean model: centres of a Poisson process, drawn cell by cell of one diameter, so that a point asks the
///          nine cells around it and no list is kept. The density makes 1 − exp(−density · area) the share.
/// Source   Chiu, Stoyan, Kendall, Mecke, "Stochastic Geometry and its Applications", 2013, chapter 3.
class Holes {
public:
  /// @param share  of the plane that is covered, in [0, 1)
  Holes(double share, Length diameter, std::uint64_t seed);

  /// Whether a point (x, y ≥ 0) lies in a hole.
  [[nodiscard]] bool cover(FieldPoint point) const;

private:
  [[nodiscard]] bool cell_covers(std::uint64_t column, std::uint64_t row, double x, double y) const;

  double diameter_um_;
  double none_in_a_cell_;  ///< probability
  double mean_in_a_cell_;
  RandomStream random_;
};

}  // namespace mezzotint
