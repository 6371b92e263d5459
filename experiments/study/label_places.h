#pragma once

#include <vector>

/// Inside of experiments/study.

namespace mezzotint {

/// Moves labels along a line until no two are nearer than `distance`, and none beyond `last`: in the order that they
/// have, and each as little as a pass down and a pass up can do.
[[nodiscard]] std::vector<double> label_places(const std::vector<double>& wanted, double distance, double last);

}  // namespace mezzotint
