#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace mezzotint {

/// The folder of one run, and what is finished in it.
///
/// `run.json` names the experiment by a digest and, for each finished stage, its output files with their
/// SHA-256. A stage counts as finished only while all of its files are there and unchanged; stages hand
/// results on through these files alone, so a resumed run gives the same bits as one that never stopped.
class RunFolder {
public:
  /// Opens a folder for an experiment. Without `resume` an earlier run in it is moved to FOLDER.previous
  /// (which is replaced), so that nothing is lost by a mistake; half-written files of a killed run are removed.
  /// @throws InvalidInput where the folder holds something that is no run, or `resume` meets another experiment.
  /// @throws DeviceError where the folder cannot be made, or another run is at work in it.
  RunFolder(std::filesystem::path folder, std::string experiment_digest, bool resume);

  [[nodiscard]] const std::filesystem::path& path() const { return folder_; }
  [[nodiscard]] std::filesystem::path operator/(const std::string& file) const { return folder_ / file; }

  [[nodiscard]] bool is_finished(const std::string& stage) const;
  /// Notes a stage as finished, with the files that it left (names within the folder).
  void finish(const std::string& stage, const std::vector<std::string>& outputs);

private:
  void save() const;

  std::filesystem::path folder_;
  nlohmann::ordered_json state_;
  std::shared_ptr<void> lock_;  ///< keeps other processes out
};

/// SHA-256 of a file.
[[nodiscard]] std::string file_digest(const std::filesystem::path& path);

}  // namespace mezzotint
