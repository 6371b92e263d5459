#pragma once

#include <string>
#include <vector>

#include "forward/surface/height_field.h"

namespace mezzotint {

/// A field whose rows fit together.
struct StepLineResult {
  HeightField field;
  std::vector<double> steps_um;  ///< that were taken out between row k and row k + 1
  /// Where what was taken out is much of the relief itself: how much, in words. Steps of the surface that run along the
  /// rows look like those of the instrument. Empty otherwise.
  std::string warning;
};

/// Takes out steps between the rows of an instrument that scans line by line: each row is moved so that the median of
/// its differences from the row before is the median of the differences around it, not zero, so that a slope of the
/// surface along y stays.
///
/// How      d_k = median over the columns of z(k + 1) − z(k), where both are measured; the running median of d over 7
///          rows is the surface's own slope, and what is left, where it exceeds 3 robust deviations, is a step.
/// Ends     a row without a measured pair to the one before keeps its offset.
/// @throws  InvalidInput for fewer than two rows.
[[nodiscard]] StepLineResult correct_step_lines(const HeightField& field);

}  // namespace mezzotint
