#pragma once

#include <string>
#include <vector>

#include "experiments/study/study.h"

namespace mezzotint {

/// Error against time as a figure for a paper: one panel for each RMS gradient (down) and incidence (across) of one
/// family of reliefs, both axes logarithmic; the Pareto front as a line, the choice of `auto` as a star, the slides'
/// plain method as the zero line.
[[nodiscard]] std::string study_svg(const StudyOptions& options, const std::vector<StudyPoint>& points,
                                    const std::string& relief);

}  // namespace mezzotint
