#pragma once

#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/study/study.h"

/// Inside of experiments/study.

namespace mezzotint {

/// The component of the page: one scene and one question at a time, which the reader picks.
[[nodiscard]] nlohmann::json study_chart(const StudyOptions& options, const std::vector<StudyPoint>& points);

}  // namespace mezzotint
