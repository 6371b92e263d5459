#pragma once

#include <string>

#include "forward/surface/height_field.h"
#include "measurement/correction/polynomial.h"

namespace mezzotint {

/// A surface whose base was made flat, whatever stands on it.
struct FlattenedBase {
  HeightField field;
  double base_share = 0.0;  ///< of the measured samples that the last polynomial was fitted to
  int iterations = 0;
  bool settled = false;  ///< whether the base stayed the same (to 1e-3 of its samples) in the last step
  /// What speaks against what was taken for the base: it did not settle, or more than a quarter of the surface lies
  /// below it. Empty where nothing does.
  std::string warning;
};

/// Levels by a polynomial through the base alone: the samples around the most frequent height. Bumps and pits do not
/// pull it, as they pull a fit through all samples.
///
/// How      From a plane through all samples on, for degree 1, 2, … `degree`: the base is what lies within 3 standard
///          deviations of the densest height, both taken from the shortest interval that holds half of all samples;
///          the polynomial is fitted to it again until the base stays. A large field walks the way through the degrees
///          on 128 to 255 of its rows, and settles on all of them.
/// Valid    more than half of the surface is base, or the base is the densest height by far.
/// @param degree  of the polynomial, 1 … 12
/// @throws  InvalidInput for another degree, or where the base does not determine the polynomial.
/// Source   the shorth: Andrews et al., "Robust Estimates of Location", 1972; Gwyddion's "Flatten Base" has the same
///          purpose (a Gaussian fitted to the peak of the height distribution, degrees 2 to 5).
[[nodiscard]] FlattenedBase flatten_base(HeightField field, int degree = 5);

}  // namespace mezzotint
