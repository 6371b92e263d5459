#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fabrication/job/descriptor.h"

namespace mezzotint {

/// What a journal knows of a layer that was begun and not finished.
struct OpenLayer {
  std::size_t index = 0;
  double least_s = 0.0;  ///< light that it surely got
  double most_s = 0.0;   ///< that it got at most, as far as the light is known to have gone off
  double taken_s = 0.0;  ///< what it is taken to have got: the rest is exposed when the print goes on
  bool certain = false;  ///< `taken_s` is known well enough to go on with what is missing
};

/// A print as its journal tells it.
struct JournalState {
  std::string job;   ///< identity of the job
  std::string plan;  ///< identity of the plan
  std::size_t layers = 0;
  std::size_t done = 0;              ///< the layers before this one are done
  std::optional<OpenLayer> open;     ///< of layer `done`
  std::vector<double> lit_s;         ///< of the layers that are done: measured, or 0 where one was skipped
  std::vector<std::size_t> decided;  ///< layers that were uncertain, and the user said how to go on
  bool finished = false;
};

/// The journal of a print on disk, one line an event, each on disk before the next thing happens.
///
/// Format   text; the first line names the job, every line ends in the first 8 digits of the SHA-256 of all text before
///          it in that line. A last line that is torn is what a crash leaves: it is cut off. A damaged line before it
///          is an error.
/// Lock     one process at a time: a second print with the same journal is refused.
/// Errors   DeviceError where the disk does not take it; FileError for a journal that is damaged.
class Journal {
public:
  /// A new journal in place of a finished one.
  /// @throws InvalidInput where an unfinished one is there
  [[nodiscard]] static Journal begin(const std::filesystem::path& path, const std::string& job, const std::string& plan,
                                     std::size_t layers);
  /// The journal of a print that goes on.
  /// @throws InvalidInput where there is none, or it is of another job or plan, or its print is finished
  [[nodiscard]] static Journal resume(const std::filesystem::path& path, const std::string& job,
                                      const std::string& plan);

  [[nodiscard]] const JournalState& state() const { return state_; }

  /// Before the light goes on: from now on the layer is uncertain.
  void exposing(std::size_t layer, double exposure_s);
  /// The light is off: the layer got `least_s` to `most_s` in this exposure.
  void cut(std::size_t layer, double least_s, double most_s, bool certain);
  void done(std::size_t layer, double lit_s);
  /// The user's word on an uncertain layer: "repeat" forgets its light, "skip" takes it as done, "complete" takes
  /// `least_s` as what it got.
  void decide(std::size_t layer, const std::string& word);
  void finished();

private:
  Journal(Descriptor file, std::filesystem::path path, JournalState state);
  void append(const std::string& text);

  Descriptor file_;
  std::filesystem::path path_;
  JournalState state_;
  OpenLayer before_;  ///< as the running exposure began
};

/// Reads a journal as far as it is whole, without a lock.
[[nodiscard]] JournalState read_journal(const std::filesystem::path& path);

}  // namespace mezzotint
