#pragma once

#include <functional>
#include <string>

namespace mezzotint {

/// How far a long piece of work has come.
struct ProgressEvent {
  std::string stage;      ///< "trace", "search", …
  double fraction = 0.0;  ///< of the stage, 0…1
  std::string note;       ///< what is being done, for people; may be empty
};

/// The one door out of long work: called with how far it is; it reports, and it may stop the work by
/// throwing (Interrupted). Called from the thread that started the work only. An empty function is
/// allowed everywhere and means: say nothing.
using Progress = std::function<void(const ProgressEvent&)>;

/// Calls `progress` if there is one.
inline void report(const Progress& progress, const std::string& stage, double fraction, const std::string& note = {}) {
  if (progress) progress({stage, fraction, note});
}

}  // namespace mezzotint
