#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "forward/surface/height_field.h"

namespace mezzotint {

/// How many heights lie in each of 2^16 bins from the highest down to the lowest: what a material ratio curve of many
/// samples is made from. Counts of parts of a surface add up.
struct HeightCounts {
  static constexpr std::size_t bins = std::size_t{1} << 16;
  float highest_um = 0.0F, lowest_um = 0.0F;
  std::vector<std::uint32_t> counts = std::vector<std::uint32_t>(bins, 0);
  std::size_t samples = 0;

  /// Counts heights between the lowest and the highest; missing ones are left out.
  void add(std::span<const float> heights_um);
  HeightCounts& operator+=(const HeightCounts& other);
  HeightCounts& operator-=(const HeightCounts& other);
};

/// The areal material ratio curve (Abbott curve, bearing curve): heights in descending order. Height k of n stands at
/// the material ratio (k + ½)/n; between them the curve is linear, and level beyond the first and the last.
///
/// Many     of more than 2^17 samples the curve is exact at the edges of 2^16 bins between the highest and the lowest,
///          and linear between them: to 1/65536 of the range of heights at worst. Not where heights fill less than a
///          sixteenth of the bins, since they come in steps, or some lie far off.
/// Units    µm; material ratio from 0 (the highest point) to 1.
/// Missing  samples are left out.
/// Source   ISO 25178-2:2021, 3.6.
class BearingCurve {
public:
  /// A straight line over all material ratios: its heights at 0 and 1.
  struct Line {
    double top_um = 0.0, bottom_um = 0.0;
  };

  static constexpr std::size_t most_exact = std::size_t{1} << 17;

  /// @throws InvalidInput where fewer than four samples are measured.
  explicit BearingCurve(const HeightField& field);
  /// @param heights_um  in any order
  explicit BearingCurve(std::vector<float> heights_um);
  explicit BearingCurve(const HeightCounts& counts);

  /// Smc(p): the height which a share p of the surface reaches.
  [[nodiscard]] double height_um(double ratio) const;
  /// Smr(c): the share of the surface that reaches a height.
  [[nodiscard]] double ratio(double height_um) const;
  /// ∫ z(q) dq from ratio `from` to ratio `to`, exactly for the curve as it is.
  [[nodiscard]] double integral_um(double from, double to) const;

  /// The line of least squares, in the direction of the heights, through the places of the curve between two ratios;
  /// where there is one place or none, through the curve at both.
  [[nodiscard]] Line line_through(double from, double to) const;

  [[nodiscard]] std::size_t samples() const { return samples_; }

private:
  void integrate();
  [[nodiscard]] double integral_to(double ratio) const;

  std::size_t samples_ = 0;
  std::vector<float> heights_um_;  // descending
  std::vector<double> ratios_;     // where they stand; ascending
  std::vector<double> sums_;       // ∫ from 0 to there
};

}  // namespace mezzotint
