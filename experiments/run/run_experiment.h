#pragma once

#include <filesystem>
#include <functional>

#include <nlohmann/json.hpp>

#include "experiments/configuration/experiment_file.h"
#include "forward/base/progress.h"

namespace mezzotint {

struct RunOptions {
  std::filesystem::path folder;
  bool resume = false;
  bool design_only = false;  ///< `mezzotint design`: nothing is printed
  /// Where the user is told at once what cannot wait for the end: whether the target is within the printer's gamut.
  std::function<void(const std::string&)> say = [](const std::string&) {};
};

/// What a run came to.
struct RunOutcome {
  std::filesystem::path folder;
  bool met = false;                ///< every tolerance: the target's and, where it came to that, the simulation's
  std::string verdict;             ///< in one sentence
  nlohmann::ordered_json summary;  ///< summary.json; design.json where the run ended before it
};

/// Runs an experiment stage by stage; each leaves its files in the run folder before the next begins.
///
/// Bits     every file is the same for the same experiment, seed, version and SIMD target, but for timing.json.
/// @throws  what its stages throw; finished stages stay on disk, and `resume` goes on after them.
[[nodiscard]] RunOutcome run_experiment(const Experiment& experiment, const RunOptions& options,
                                        const Progress& progress);

/// What identifies a run: program version, all settings, printer profile, and the content of a scan.
[[nodiscard]] std::string experiment_digest(const Experiment& experiment);

/// Whether the lobes are what a run is for, and its tolerance their cube-root error; else the slopes are. A scan is by
/// its light, unless `[search] objective` says otherwise.
[[nodiscard]] bool is_by_light(const Experiment& experiment);

}  // namespace mezzotint
