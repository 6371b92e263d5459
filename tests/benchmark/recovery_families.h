#pragma once

#include <cstdint>
#include <vector>

#include "forward/pattern/pattern.h"
#include "forward/surface/slope_covariance.h"
#include "inverse/design/design_variables.h"

namespace mezzotint::benchmark {

/// A family of patterns, what is free in it, and the narrower ranges that truths are drawn from.
struct Family {
  char letter;  ///< S sinusoid, R ridges, N noise, C combined
  Pattern pattern;
  std::vector<FreeParameter> free, truth;
  std::size_t pixels;  ///< of the patch a search prints, a side
  std::size_t draws;   ///< that a search sees
  double tolerance;    ///< of the slope covariance
};

[[nodiscard]] std::vector<Family> recovery_families();

/// A pattern of the family, drawn at random by the number of the target.
[[nodiscard]] Pattern truth_of(const Family& family, std::uint64_t target);

/// Pixels a side of the patch on which results are judged.
[[nodiscard]] inline std::size_t judged_pixels(const Family& family) { return family.pixels == 96 ? 192 : 256; }

/// The largest relative error of a variance along any axis.
[[nodiscard]] double largest_error(const SlopeCovariance& found, const SlopeCovariance& truth);

}  // namespace mezzotint::benchmark
