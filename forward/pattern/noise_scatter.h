#pragma once

#include <span>

#include "forward/pattern/noise_lattice.h"

/// Inside of forward/pattern, and for forward/process.

namespace mezzotint {

/// Adds amplitude·noise(map(c·pitch_x, r·pitch_y), z) to sample (c, r) of a grid: each impulse is added to the samples
/// that it reaches, by rows, in vectors. Where cells are smaller than samples, the cells around each sample are summed
/// instead, so that the cost stays bounded. The same bits with any number of threads and any instruction set; single
/// precision (2e-6 of the noise's unit).
///
/// Gradient where `toward_u` and `toward_v` are given, amplitude·∂noise/∂(u, v) is added to them, for about twice the
///          cost; the values have the same bits as without.
/// Shape    `values` and both others row by row; a NaN stays one.
/// Errors   InvalidInput where a coordinate of the noise reaches ±2^20.
/// Source   sparse_noise.h has the noise; scattering instead of gathering: Lewis 1989.
void add_sparse_noise(std::span<float> values, const Grid& grid, const PatternMap& map, const NoiseLattice& lattice,
                      double z, double amplitude, std::span<float> toward_u = {}, std::span<float> toward_v = {});

}  // namespace mezzotint
