#pragma once

#include <vector>

#include "experiments/report/report.h"
#include "experiments/study/study.h"

namespace mezzotint {

/// The study as a page: the reader picks relief, gradient and incidence, and reads single points.
[[nodiscard]] Report study_page(const StudyOptions& options, const std::vector<StudyPoint>& points);

}  // namespace mezzotint
