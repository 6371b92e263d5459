#pragma once

#include <optional>

#include "measurement/pattern_fit/line_model.h"

/// Inside of measurement/pattern_fit.

namespace mezzotint {

/// Where the least squares begin: from the highest peaks of the spectrum under a Hann window, interpolated; the phases
/// and the height by projection.
[[nodiscard]] std::optional<LineNumbers> line_start(LineKind kind, const HeightField& whole);

}  // namespace mezzotint
