#pragma once

#include "experiments/run/run_experiment.h"

namespace mezzotint {

/// A target of kind "regions": one design a region, each in a folder of its own (region_LABEL), then one layer.
///
/// Layer    every pixel has the gray value that the design of its region has there: each keeps its own height above the
///          layer's foot, so that it prints as it was judged. At borders the blur mixes the two over its own width.
/// Files    design.json, pattern.toml (a pattern of kind "regions"), gray.png, relief.gwy, report.html. The relief has
///          fewer samples a pixel where the picture is large.
/// @throws InvalidInput for a free form, for a picture larger than the printer's, or as run_experiment.
[[nodiscard]] RunOutcome design_regions(const Experiment& experiment, const RunOptions& options,
                                        const Progress& progress);

}  // namespace mezzotint
