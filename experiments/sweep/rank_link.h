#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "experiments/sweep/ranks.h"

/// Inside of experiments/sweep.

namespace mezzotint {

/// What ranks say to each other. Workers to rank 0: Want, Result, Failed, Finished, Gone; rank 0 to workers: Tasks,
/// Stop.
enum class Note : int {
  Want = 1,  ///< so many tasks, please
  Tasks,     ///< their indices; none: there are no more
  Result,    ///< index, and bytes
  Failed,    ///< a task threw: status, and message
  Finished,  ///< this rank leaves the sweep
  Stop,      ///< leave the sweep: status
  Gone       ///< this rank failed outside of a sweep: status, and message
};

struct Letter {
  Note note = Note::Stop;
  std::string bytes;
};

/// Letters between ranks; MPI stays behind it.
struct Ranks::Link {
  int rank = 0, count = 1;
  bool started = false;

  void send(int to, Note note, std::string_view bytes) const;
  /// The next letter of a rank, if it has come.
  [[nodiscard]] std::optional<Letter> receive(int from) const;
};

/// A number, and what follows it, as bytes.
[[nodiscard]] std::string numbered(std::uint64_t number, std::string_view rest = {});
[[nodiscard]] std::uint64_t number_of(std::string_view bytes);
[[nodiscard]] std::string_view rest_of(std::string_view bytes);

}  // namespace mezzotint
