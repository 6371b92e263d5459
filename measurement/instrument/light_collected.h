#pragma once

/// Inside of measurement/instrument.

namespace mezzotint {

/// Share of the light of a smooth facet that comes back into the aperture which also lights it: 1 of a level facet, 0
/// from the acceptance angle, whose sine is the aperture, on.
///
/// How      the pupil's disc and its mirror image overlap; a facet at the angle β moves the image by sin β/NA of a
///          diameter (exact at either end, and to first order between them).
/// Units    slope = tan β; a numerical aperture in (0, 1].
/// Source   the geometry of a coaxial instrument over a mirror; its end is the acceptance angle arcsin(NA) of data
/// sheets.
[[nodiscard]] double light_collected(double slope, double numerical_aperture);

/// A probability that goes wrong with little light: its odds grow as 1 ÷ light. The same at light 1; 1 without light.
[[nodiscard]] double probability_at(double light, double probability);

}  // namespace mezzotint
