#pragma once

#include "forward/surface/height_field.h"

namespace mezzotint::benchmark {

/// The relief of all figures: a periodic sum of three octaves of sparse noise, with 16, 32 and 64 lattice cells across
/// and amplitudes 1, ½ and ¼, scaled to the RMS gradient √E|∇h|². At 1024² and 0.3 its heights span about 19 cells.
[[nodiscard]] HeightField noise_relief(std::size_t size, double gradient);

}  // namespace mezzotint::benchmark
