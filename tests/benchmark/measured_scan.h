#pragma once

#include "forward/surface/height_field.h"

namespace mezzotint::benchmark {

/// A scan as an instrument delivers it, for the figures of measurement: the relief of `noise_relief` as a patch, 2 µm
/// RMS, on a tilted and bent base, with spikes of 20 to 60 µm on 0.3 % of the samples. Always the same.
[[nodiscard]] HeightField measured_scan(std::size_t size);

/// The same with 1 % of the samples missing, alone and in small groups, and a round hole with a radius of 1/16 of the
/// side.
[[nodiscard]] HeightField scan_with_holes(std::size_t size);

}  // namespace mezzotint::benchmark
