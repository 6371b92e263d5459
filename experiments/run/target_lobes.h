#pragma once

#include <optional>

#include "experiments/configuration/experiment_file.h"
#include "experiments/run/run_folder.h"
#include "inverse/target/lobe_target.h"
#include "inverse/target/target.h"

namespace mezzotint {

/// The lobes that a run wants, or compares with where slopes are what it wants; none for an anisotropy alone. Those of
/// a scan come from the folder's target.gwy, by single reflection without shadows.
/// @throws InvalidInput with the reason for a target that cannot be.
[[nodiscard]] std::optional<LobeTarget> target_lobes(const Experiment& experiment, const RunFolder& folder,
                                                     const Target& target);

/// A target that names no slopes, by those that its lobes imply.
[[nodiscard]] Target target_of_lobes(const TargetSpecification& wanted, const SimulationSpecification& simulation);

}  // namespace mezzotint
