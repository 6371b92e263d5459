#pragma once

#include <string>
#include <vector>

#include "forward/surface/height_field.h"

namespace mezzotint {

/// Where the samples of a relief are no good base for its slopes: features or steps within a few samples, an offset
/// that single precision cannot carry, a measured patch that holds too few features to stand for its texture. Sentences
/// that say by how much, and what would be right; none for a relief without such faults.
///
/// How      From up to 64 rows: the variance of the slopes over one sample and over two. Over two a sine of N samples
///          keeps cos²(π/N) of it, a step ½, white noise ¼; below 0.55 (N = 4.3) it warns.
/// Missing  samples and their neighbours are left out.
[[nodiscard]] std::vector<std::string> relief_warnings(const HeightField& field);

}  // namespace mezzotint
