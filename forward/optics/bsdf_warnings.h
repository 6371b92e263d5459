#pragma once

#include <string>
#include <vector>

#include "forward/optics/bsdf.h"

namespace mezzotint {

/// What a user must know before a result is trusted: sentences that say what is wrong, by how much, and what would be
/// right. They stand in the provenance as "warnings", one a line, so that they travel with the file.

/// Adds sentences behind those that are there; one that is there already is not added again.
void add_warnings(Bsdf& bsdf, const std::vector<std::string>& sentences);

/// The sentences of a result; none where nothing was to be said.
[[nodiscard]] std::vector<std::string> warnings_of(const Provenance& provenance);

/// Where the bins of a map are too coarse for its lobe: light in bins that the horizon cuts, and a lobe that is
/// narrower than a bin. Of reflection and transmission, where they hold more than a thousandth of the light.
/// How  Σ p² over the bins, p a bin's share of the light, is 1/(4π v) for a Gaussian lobe with the variance v (in
/// bins),
///      so below 4π effective bins the lobe's standard deviation is less than a bin's width. By two independent halves,
///      so that noise does not count.
[[nodiscard]] std::vector<std::string> map_warnings(const Bsdf& bsdf);

}  // namespace mezzotint
