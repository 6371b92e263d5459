#pragma once

#include <algorithm>
#include <cmath>

#include "forward/surface/resample.h"

namespace mezzotint {

/// Where the design lies in the measurement's frame; see Registration.
class Placement {
public:
  Placement() = default;
  /// @param rotation  radians
  Placement(FieldPoint centre, FieldPoint shift, double rotation)
      : centre_(centre), shift_(shift), rotation_(rotation), cos_(std::cos(rotation)), sin_(std::sin(rotation)) {}

  [[nodiscard]] FieldPoint centre() const { return centre_; }
  [[nodiscard]] FieldPoint shift() const { return shift_; }
  [[nodiscard]] double rotation() const { return rotation_; }

  [[nodiscard]] FieldPoint to_measured(FieldPoint design) const {
    const double x = design.x_um - centre_.x_um;
    const double y = design.y_um - centre_.y_um;
    return {cos_ * x - sin_ * y + centre_.x_um + shift_.x_um, sin_ * x + cos_ * y + centre_.y_um + shift_.y_um};
  }
  [[nodiscard]] FieldPoint to_design(FieldPoint measured) const {
    const FieldPoint turned = turn_back({measured.x_um - centre_.x_um - shift_.x_um,  //
                                         measured.y_um - centre_.y_um - shift_.y_um});
    return {turned.x_um + centre_.x_um, turned.y_um + centre_.y_um};
  }
  /// A displacement seen in the measurement, in the design's axes.
  [[nodiscard]] FieldPoint turn_back(FieldPoint v) const {
    return {cos_ * v.x_um + sin_ * v.y_um, -sin_ * v.x_um + cos_ * v.y_um};
  }

private:
  FieldPoint centre_;
  FieldPoint shift_;
  double rotation_ = 0.0;
  double cos_ = 1.0;
  double sin_ = 0.0;
};

/// Half the diagonal of a grid: how far its corners are from its middle.
[[nodiscard]] inline double half_diagonal_um(const Grid& grid) {
  const FieldPoint middle = middle_of(grid);
  return std::hypot(middle.x_um, middle.y_um);
}

/// How much `samples` heights that correlate by r speak for a placement: twice the gain in log-likelihood over
/// "unrelated", were the samples independent. Unlike r itself it does not favour small overlaps, where r scatters.
[[nodiscard]] inline double evidence(double r, double samples) {
  constexpr double largest = 0.9999;  // where r is as good as 1, the larger overlap decides
  return r <= 0.0 ? 0.0 : -samples * std::log1p(-std::min(r, largest) * std::min(r, largest));
}

}  // namespace mezzotint
