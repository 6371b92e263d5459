#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "forward/surface/height_field.h"

namespace mezzotint {

/// The areal material ratio curve (Abbott curve, bearing curve): heights in descending order. Height k of n stands at
/// the material ratio (k + ½)/n; between them the curve is linear, and level beyond the first and the last.
///
/// Units    µm; material ratio from 0 (the highest point) to 1.
/// Missing  samples are left out.
/// Source   ISO 25178-2:2021, 3.6.
class BearingCurve {
public:
  /// @throws InvalidInput where fewer than four samples are measured.
  explicit BearingCurve(const HeightField& field);
  /// @param heights_um  in any order
  explicit BearingCurve(std::vector<float> heights_um);

  /// Smc(p): the height which a share p of the surface reaches.
  [[nodiscard]] double height_um(double ratio) const;
  /// Smr(c): the share of the surface that reaches a height.
  [[nodiscard]] double ratio(double height_um) const;
  /// ∫ z(q) dq from ratio `from` to ratio `to`, exactly for the curve as it is.
  [[nodiscard]] double integral_um(double from, double to) const;

  [[nodiscard]] std::span<const float> heights_um() const { return heights_um_; }

private:
  [[nodiscard]] double integral_to(double ratio) const;

  std::vector<float> heights_um_;  // descending
  std::vector<double> sums_;       // ∫ from 0 to the place of height k
};

}  // namespace mezzotint
