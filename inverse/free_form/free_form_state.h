#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "inverse/free_form/free_form.h"

/// Inside of inverse/free_form: a search on its way, and its file.

namespace mezzotint {

/// A relief that grows from one start, stage by stage.
struct Growth {
  std::string start;
  std::vector<double> wanted_um;
  std::vector<double> history;       ///< the objective at every evaluation
  std::vector<double> after;         ///< the objective after every finished stage; that before, for a correction
  int evaluations = 0;               ///< in finished stages
  std::vector<DirectionMap> beyond;  ///< what tracing showed beyond the model; empty before a correction
};

/// Its objective now.
[[nodiscard]] inline double last_of(const Growth& growth) { return growth.after.back(); }

/// All growths, and the best that any has had. Stages are numbered, so that a search knows what is left to do.
struct FreeFormState {
  std::vector<Growth> growths;
  Growth best;  ///< empty before the first evaluation of the objective; else with one `after`
  std::size_t pixels = 0;
};

/// Digest of everything that the result depends on.
[[nodiscard]] std::string problem_digest(const LobeTarget& goal, const PrinterProfile& printer,
                                         const FreeFormOptions& options);

/// Written aside, then renamed; doubles to their last bit.
void write_state(const std::filesystem::path& path, const std::string& problem, const FreeFormState& state);

/// @param problem  digest that the state must have; empty: any
/// @throws FileError for a file that is no state, is damaged, or is that of another problem.
[[nodiscard]] FreeFormState read_state(const std::filesystem::path& path, const std::string& problem);

}  // namespace mezzotint
