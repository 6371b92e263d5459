#pragma once

#include <string>
#include <vector>

#include "forward/surface/height_field.h"
#include "measurement/texture/roughness.h"
#include "measurement/texture/spatial_parameters.h"

namespace mezzotint {

/// What must be known before the parameters of a surface are trusted, one sentence each, with figures: that Sz grows
/// with the area and Sdq with the resolution (by how much, here); that steep parts, or many, are missing; that the
/// field is too small for its correlation length.
///
/// How      Sz of sixteenths; Sdq of every second sample, from a tenth less on; slopes beside missing samples against
///          those elsewhere, from a quarter more on (a tenth where 1 % or more is missing); Sal against a block's side,
///          from a quarter on: ± 2 standard errors hold the Sq of the endless surface in 83 to 95 % of fields with
///          less, in 75 % at a half, 53 % at one.
/// @param field    levelled and filtered: what the parameters belong to
/// @param spatial  null where the field is too small for them
[[nodiscard]] std::vector<std::string> texture_notes(const HeightField& field, const AreaRoughness& roughness,
                                                     const SpatialParameters* spatial);

/// Where the heights of a file come in steps whose rounding alone makes a tenth of Sdq or more: that, in words; else
/// empty. Steps are found where most neighbours differ by a few whole ones.
/// @param as_read  not levelled: a plane hides the steps
[[nodiscard]] std::string height_step_note(const HeightField& as_read, const AreaRoughness& roughness);

}  // namespace mezzotint
