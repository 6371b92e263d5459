#pragma once

#include <cstdint>

#include "forward/surface/height_field.h"

namespace mezzotint {

/// How a sample lies under a simulated profilometer, and what that adds.
///
/// Frame    a point p of the sample is seen at R(rotation)·(p − centre) + centre + shift in the instrument;
///          centre = the middle of the relief's samples.
struct VirtualProfilometer {
  Length pitch = Length::from_um(2.0);
  Length shift_x = Length::from_um(0.0);
  Length shift_y = Length::from_um(0.0);
  Angle rotation;
  double tilt_x = 0.0;  ///< slope of the sample's plane, not levelled by hand
  double tilt_y = 0.0;
  Length noise = Length::from_nm(0.0);  ///< standard deviation of each height
  double missing_share = 0.0;           ///< of samples that the instrument does not see, in [0, 0.5]
  std::uint64_t seed = 1;
};

/// Measures a relief: bicubic resampling at the instrument's pitch, placed and tilted, with noise; samples that
/// fall outside of the relief are missing, and so are those that would need a height which the relief lacks.
///
/// Shape    covers the relief's own extent (its bounding rectangle before rotation). A periodic relief is a patch
///          on the stage too: it is known up to the end of its period, and not continued.
/// Pixels   where the instrument's pitch is the larger one, a height is the mean over its square pixel, as a
///          camera sees it; single points would alias the finer relief into the measurement. A pixel that is
///          not wholly on the relief is missing.
/// Tilt     is added to the heights (about the centre, in the instrument's frame); a real one also foreshortens
///          lengths by 1 − tilt²/2, which is left out.
/// Noise    white, Gaussian; the samples that are missing are independent of each other.
/// @throws InvalidInput for a pitch that is not positive, a missing share outside of [0, 0.5], a noise that is
///         negative, or numbers that are not finite.
[[nodiscard]] HeightField measure_virtually(const HeightField& relief, const VirtualProfilometer& instrument);

}  // namespace mezzotint
