#pragma once

#include <cstddef>

#include "forward/base/quantity.h"
#include "forward/surface/height_field.h"

namespace mezzotint {

/// Areal height and hybrid parameters of ISO 25178-2, about the arithmetic mean of the field as it is (level
/// it first), each with a standard error.
///
/// Units    Sa, Sq, Sp, Sv, Sz in µm; Ssk, Sku, Sdq in 1; Sdr in 1 (a ratio, not per cent).
/// Missing  samples that are missing are left out; Sdq and Sdr use cells whose four corners are measured.
/// Standard errors: delete-one-block jackknife over 16 blocks, so that the correlation
///          of neighbours is respected; Sp, Sv and Sz are extreme values
///          and have none (NaN).
/// A flat field has no shape: its Ssk and Sku are NaN.
/// Differences from Gwyddion 2.62: Sku is ISO's (3 for a Gaussian), not the excess; Sdq and Sdr are taken over
///          the same two triangles a cell that rays meet, where Gwyddion uses one-sided differences and four
///          triangles with a flat rim.
/// Source   ISO 25178-2:2021, 4.1–4.3.
struct AreaRoughness {
  Quantity Sa, Sq, Sp, Sv, Sz, Ssk, Sku, Sdq, Sdr;
  std::size_t samples = 0;
  std::size_t missing = 0;
};

/// @throws InvalidInput when fewer than four samples, or no whole cell, are left.
[[nodiscard]] AreaRoughness area_roughness(const HeightField& field);

}  // namespace mezzotint
