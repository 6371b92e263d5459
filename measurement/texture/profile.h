#pragma once

#include <string>
#include <vector>

#include "forward/base/quantity.h"
#include "forward/surface/height_field.h"
#include "forward/surface/resample.h"

namespace mezzotint {

/// Heights along a straight line.
struct Profile {
  Length spacing;
  std::vector<double> heights_um;  ///< NaN where missing
};

/// The heights along the line from one point to another, by cubic convolution, as finely spaced as the samples are
/// along it.
/// @throws InvalidInput where the line leaves the field, or is shorter than 16 spacings.
[[nodiscard]] Profile profile_along(const HeightField& field, FieldPoint from, FieldPoint to);

/// A Gaussian profile filter (ISO 16610-21), corrected at the ends and beside missing values by regression of the first
/// order (ISO 16610-28): the mean line, missing where the profile is.
/// @throws InvalidInput for a cut-off that is not positive and finite.
[[nodiscard]] Profile mean_line(const Profile& profile, Length cutoff);

/// Which wavelengths count as roughness.
struct ProfileFilter {
  Length lambda_s;  ///< removes shorter ones; 0: none
  Length lambda_c;  ///< removes longer ones, and is the sampling length; 0: none (primary profile P)
};

/// Profile parameters, of roughness (R…) where lambda_c is set, else of the primary profile (P…), under the names
/// without that letter.
///
/// Form     the least-squares line is taken out first.
/// Units    a, q, t, p, v, z, Sm in µm; sk, ku, dq in 1.
/// z, p, v  means over the sampling lengths (of lambda_c; or the whole profile); t over the whole.
/// Sm       mean width of profile elements: a peak with the valley beside it, where both rise and fall by a tenth of z
///          and are wider than 1 % of the sampling length. NaN where no whole element is found; one that a missing
///          value interrupts does not count.
/// Slopes   dq by the seven-point derivative of ISO 4287, of the sixth order in the spacing; without the three values
///          at each end and beside missing ones.
/// Standard errors: where there are two sampling lengths or more, else NaN. z, p, v: of their mean; a, q, sk, ku, dq:
///          jackknife over sampling lengths; Sm: of the mean over elements; t is an extreme value and has none.
/// Source   ISO 4287:1997 / ISO 21920-2:2021 (Ra, Rq, Rt, Rp, Rv, Rz, RSm, Rsk, Rku, Rdq).
struct ProfileParameters {
  char letter = 'P';  ///< 'P' or 'R'
  Quantity a, q, t, p, v, z, sk, ku, dq, sm;
  std::size_t sampling_lengths = 1;
  double missing_share = 0.0;
};

/// @throws InvalidInput where fewer than 16 heights are measured, or the profile is shorter than one sampling length.
[[nodiscard]] ProfileParameters profile_parameters(const Profile& profile, const ProfileFilter& filter = {});

}  // namespace mezzotint
