#pragma once

#include <string>
#include <vector>

#include "experiments/study/study.h"

namespace mezzotint {

/// Error against time as a figure for a paper: one panel for each RMS gradient (down) and incidence (across) of one
/// relief, both axes logarithmic, with the rungs of the ladder, the slides' plain method as the zero line, the Pareto
/// front of all methods, and what `auto` chose.
[[nodiscard]] std::string study_svg(const StudyOptions& options, const std::vector<StudyPoint>& points,
                                    const std::string& relief);

/// What else one may choose: one panel for each question (across; placement, tracer, normals, mesh, bounce cap) and
/// relief (down), at the middle gradient and the last but one direction of the light.
[[nodiscard]] std::string study_choices_svg(const StudyOptions& options, const std::vector<StudyPoint>& points);

}  // namespace mezzotint
