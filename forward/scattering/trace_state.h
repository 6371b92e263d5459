#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "forward/scattering/batch_tally.h"

namespace mezzotint {

/// What has been traced so far: tallies that only grow, pass by pass.
struct TraceState {
  std::vector<BatchTally> tallies;   ///< one a batch
  std::uint64_t rays_per_batch = 0;  ///< traced so far
  std::uint32_t passes = 0;
  /// Relative standard error after each pass, with the number of paths: how it converged.
  struct Mark {
    std::uint64_t paths = 0;
    double error = 0.0;
  };
  std::vector<Mark> convergence;
};

/// Reads a state into tallies that already have their sizes; nothing happens where there is no file.
/// @param run  digest of all that the result depends on but the budget.
/// @throws FileError for a file that is damaged, or is the state of another run.
void read_state(const std::filesystem::path& path, const std::string& run, TraceState& state);
/// Written aside, then renamed.
void write_state(const std::filesystem::path& path, const std::string& run, const TraceState& state);

}  // namespace mezzotint
