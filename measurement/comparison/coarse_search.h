#pragma once

#include <vector>

#include "forward/base/progress.h"
#include "forward/base/units.h"
#include "measurement/comparison/feature_scale.h"
#include "measurement/comparison/placement.h"

namespace mezzotint {

/// A placement found at reduced resolution, good to about half a feature.
struct Candidate {
  Placement placement;
  double score = 0.0;
};

struct CoarseSearch {
  std::vector<Candidate> candidates;  ///< separate ones, the likeliest first
  Length pitch;                       ///< of the reduced resolution
  double independent_trials = 1.0;    ///< about how many separate placements were compared
  MainLobe lobe;
};

/// Compares all placements that let a fifth of the smaller surface overlap, over rotations in ±`largest_rotation`.
/// @param design, measured  patches, levelled.
[[nodiscard]] CoarseSearch search_coarsely(const HeightField& design, const HeightField& measured,
                                           Angle largest_rotation, const Progress& progress);

}  // namespace mezzotint
