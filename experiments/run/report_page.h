#pragma once

#include "experiments/report/report.h"
#include "experiments/run/run_results.h"

namespace mezzotint {

/// The page of a run.
[[nodiscard]] Report make_page(const Experiment& experiment, const RunResults& results);

/// Its sections, each in the order of the loop.
[[nodiscard]] Section lobe_section(const Experiment& experiment, const RunResults& results);
[[nodiscard]] Section design_section(const Experiment& experiment, const RunResults& results);
[[nodiscard]] Section print_section(const Experiment& experiment, const RunResults& results);
[[nodiscard]] Section measurement_section(const RunResults& results);
[[nodiscard]] Section assumptions_section(const Experiment& experiment, const RunResults& results);

}  // namespace mezzotint
