#pragma once

#include <string>

#include "forward/surface/height_field.h"

namespace mezzotint {

/// The S-filter of ISO 25178-3: removes what is shorter than the nesting index, by an areal Gaussian filter of that
/// cut-off wavelength. Half of the amplitude of a wave as long as the cut-off passes, 2^(−(cutoff/λ)²) of any other.
///
/// Ends     corrected by regression of the first order: at the rim, and beside missing samples, the filter is the
///          weighted least-squares plane at the sample, so that a tilted surface stays as it is. In the middle of
///          measured samples that is the Gaussian filter itself. A periodic field is filtered round its ends.
/// Missing  samples have no weight, and stay missing.
/// How      by FFT in tiles: a few seconds for 10^8 samples whatever the cut-off, memory for some tiles only. Weights
///          end at 1.2 cut-offs, where they are 1e-9 of the largest.
/// @throws  InvalidInput for a cut-off that is not positive and finite, or longer than a periodic field.
/// Source   ISO 16610-61:2015 (weights exp(−π r²/(α λ)²), α = √(ln 2/π)); end effects: ISO 16610-28:2016, the moment
///          criterion of the first order.
[[nodiscard]] HeightField s_filter(const HeightField& field, Length cutoff);

/// The L-filter of ISO 25178-3: removes what is longer than the nesting index: the field minus its S-filter.
/// The mean goes to nowhere: the datum stays as it was.
/// @throws  as s_filter
[[nodiscard]] HeightField l_filter(const HeightField& field, Length cutoff);

/// Where a cut-off does not fit to the field, in words; else empty: so near the spacing that the samples hold no such
/// filter (at the cut-off itself more than 0.55 of the amplitude passes), or longer than the field, of which the
/// S-filter then leaves hardly more than a plane.
[[nodiscard]] std::string filter_warning(const HeightField& field, Length cutoff);

}  // namespace mezzotint
