#pragma once

#include <cstddef>
#include <string>

#include "forward/surface/height_field.h"

namespace mezzotint {

/// A field without its outliers.
struct OutlierResult {
  HeightField field;
  std::size_t removed = 0;
  /// Share of the measured samples that were taken, and the share that Gaussian heights would lose by chance.
  double share = 0.0, expected_share = 0.0;
  /// Where they look like real features of the surface rather than like errors of the instrument: what speaks for it,
  /// in words. Empty where nothing does.
  std::string warning;
};

/// Samples further than `k` standard deviations from the mean (after the least-squares plane) become missing.
///
/// Valid    surfaces with nearly Gaussian heights. On others (bumps on a base, ridges) the highest features themselves
///          lie further off; that is noticed by how many go, by their lying together and by their all being on one
///          side, and said in `warning`.
/// @throws  InvalidInput for k not in [1, 100].
[[nodiscard]] OutlierResult mask_outliers(HeightField field, double k);

/// Samples further than `k` robust standard deviations from the median of the (up to 24) measured samples around them
/// become missing: spikes, on a surface whose own features are wider than five samples. The deviation is that of all
/// samples from their medians: 1.4826 times its median, or the quantum of heights so coarse that this is 0.
/// @throws  InvalidInput for k not in [1, 1000].
[[nodiscard]] OutlierResult mask_local_outliers(HeightField field, double k);

}  // namespace mezzotint
