#pragma once

#include "forward/surface/height_field.h"
#include "measurement/comparison/masked_correlation.h"

namespace mezzotint {

/// A height field as an image of mean 0 and mean square 1.
/// @throws MethodError where it is flat, or nothing was measured.
[[nodiscard]] MaskedImage standardised(const HeightField& field);

/// How far a relief must be moved, in the direction where that is shortest, until its correlation with itself
/// has fallen to one half. A sinusoid has 1/6 of its wavelength.
[[nodiscard]] double feature_half_width_um(const HeightField& field);

/// The displacements under which a relief still resembles itself without a break: the part of its autocorrelation
/// above 0.3 that hangs together with no displacement at all. Two placements further apart are separate ones.
class MainLobe {
public:
  explicit MainLobe(const HeightField& field);
  [[nodiscard]] bool holds(double x_um, double y_um) const;
  [[nodiscard]] double area_um2() const;

private:
  void fill(const CorrelationMap& map);
  double pitch_x_um_;
  double pitch_y_um_;
  std::ptrdiff_t reach_x_;
  std::ptrdiff_t reach_y_;
  std::vector<char> inside_;  ///< (2·reach_y + 1) rows of (2·reach_x + 1), no displacement in the middle
};

}  // namespace mezzotint
