#pragma once

#include <cstdint>

#include "forward/surface/height_field.h"

namespace mezzotint {

/// How a sample lies under a simulated profilometer, what the instrument passes on, and what it adds.
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
  Length offset;                        ///< of all heights: where the instrument's scale has its zero
  Length bandwidth;                     ///< lateral period limit: half of the amplitude passes; 0: no optics
  Length noise = Length::from_nm(0.0);  ///< standard deviation of each height
  double missing_share = 0.0;           ///< of level samples that are not seen, each by itself, in [0, 0.5]
  double hole_share = 0.0;              ///< of the area that is not seen, in round holes, in [0, 0.5]
  Length hole_diameter;
  double outlier_share = 0.0;  ///< of level samples that are spikes, in [0, 0.5]
  Length outlier_size;         ///< spikes lie within ± this about the height, anywhere alike
  double aperture = 0.0;       ///< numerical, up to 1; 0: any slope sends as much light as a level one
  std::uint64_t seed = 1;
};

/// Measures a relief: bicubic resampling at the instrument's pitch, placed and tilted, blurred, with noise, spikes and
/// holes; samples that fall outside of the relief are missing, and so are those that would need a height which the
/// relief lacks.
///
/// Shape    covers the relief's own extent (its bounding rectangle before rotation). A periodic relief is a patch
///          on the stage too: it is known up to the end of its period, and not continued.
/// Optics   a Gaussian transfer of heights, 2^(−(bandwidth/λ)²) at the wavelength λ: the S-filter of that cut-off. It
///          has one number, which data sheets state. An incoherent microscope's own transfer is nearly a straight line
///          that ends at λ/(2 NA), and holds for heights well below λ/4 alone; a Gaussian never quite ends.
/// Pixels   where the instrument's pitch is the larger one, a height is the mean over its square pixel, as a
///          camera sees it; single points would alias the finer relief into the measurement. A pixel that is
///          not wholly on the relief is missing.
/// Slopes   with an aperture, a smooth facet at an angle β sends less light back (none from sin β = aperture on):
///          nothing is seen there, and short of it the odds of a spike and of a missing sample are those of level ones
///          divided by the light. β is that of the relief after the optics, with the tilt, in the middle of the pixel.
/// Tilt     is added to the heights (about the centre, in the instrument's frame); a real one also foreshortens
///          lengths by 1 − tilt²/2, which is left out.
/// Offset   goes to the datum, in double.
/// Noise    white, Gaussian, after the optics; samples that are missing singly, and spikes, are independent of each
///          other.
/// @throws InvalidInput for a pitch that is not positive, a share outside of [0, 0.5], an aperture outside of [0, 1],
///         a length that is negative, holes without a diameter, a bandwidth longer than the period of the relief, or
///         numbers that are not finite.
/// Source   lateral period limit, instrument transfer function: ISO 25178-600:2019; de Groot, "The instrument transfer
///          function for optical measurements of surface topography", J. Phys. Photonics 3 (2021).
[[nodiscard]] HeightField measure_virtually(const HeightField& relief, const VirtualProfilometer& instrument);

}  // namespace mezzotint
