#pragma once

#include <cstddef>
#include <cstdint>

#include "forward/surface/height_field.h"

/// Inside of experiments/study: ways to correct and to judge a surface that exist for comparison only.

namespace mezzotint {

/// Missing samples on the least-squares plane.
[[nodiscard]] HeightField fill_by_plane(const HeightField& field);
/// From there on so many sweeps of Gauss and Seidel towards Laplace's equation (for equal spacings).
[[nodiscard]] HeightField fill_by_relaxation(const HeightField& field, int sweeps);

/// A Gaussian filter by sums over weights up to so many cut-offs, one axis after the other; at the ends the weights
/// that are left are taken for all. For a field without missing samples.
[[nodiscard]] HeightField smooth_by_sums(const HeightField& field, Length cutoff, double reach_in_cutoffs);
/// By FFT as if the field were a period of itself.
[[nodiscard]] HeightField smooth_wrapped(const HeightField& field, Length cutoff);

/// Sq in µm of every `step`-th sample along either axis, of `count` samples drawn at random, of the first `rows` rows.
[[nodiscard]] double sq_of_every(const HeightField& field, std::size_t step);
[[nodiscard]] double sq_of_random(const HeightField& field, std::size_t count, std::uint64_t seed);
[[nodiscard]] double sq_of_rows(const HeightField& field, std::size_t rows);

}  // namespace mezzotint
