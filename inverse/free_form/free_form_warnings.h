#pragma once

#include <string>
#include <vector>

#include "inverse/free_form/free_form.h"

/// Inside of inverse/free_form: what is said about a goal and a result.

namespace mezzotint {

/// Before anything is allocated.
/// @throws InvalidInput as `find_free_form`.
void require_valid_search(const LobeTarget& goal, const FreeFormOptions& options);

/// The weighted sum of a judgement's squares; of their floors.
[[nodiscard]] double weighted_sum(const std::vector<WeightedDistance>& objective, const LobeJudgement& judgement,
                                  Estimate JudgedDistance::*figure = &JudgedDistance::square);

[[nodiscard]] std::vector<std::string> free_form_warnings(const LobeTarget& goal, const PrinterProfile& printer,
                                                          const FreeFormOptions& options, const FreeForm& found);

}  // namespace mezzotint
