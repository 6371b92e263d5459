#pragma once

#include <string>
#include <vector>

#include "forward/surface/height_field.h"

namespace mezzotint {

/// Words about whether the slopes of a relief are Gaussian, as the rung `moments` takes them to be: by their kurtosis
/// along both principal axes (3 for a Gaussian; 1 for ridges, 2.25 for sin·sin, 3.4 for sparse noise, whose lobe is off
/// by 10 %). Empty within ±0.2 of 3, where the lobe is off by a few per cent.
[[nodiscard]] std::vector<std::string> gaussian_slopes_warnings(const HeightField& field);

}  // namespace mezzotint
