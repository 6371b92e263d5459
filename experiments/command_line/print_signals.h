#pragma once

#include "fabrication/session/session_control.h"

namespace mezzotint {

/// While it lives, SIGINT, SIGTERM and SIGHUP ask a print to stop, SIGTSTP to pause, and SIGPIPE is ignored: none of
/// them ends the process with the light on. One at a time.
class PrintSignals {
public:
  explicit PrintSignals(SessionControl& control);
  ~PrintSignals();
  PrintSignals(const PrintSignals&) = delete;
  PrintSignals& operator=(const PrintSignals&) = delete;

  /// For a pause that Ctrl-Z asked for: stops the process as Ctrl-Z does, and returns after `fg`.
  static void stop_process();

private:
  struct Kept;
  Kept* kept_;
};

}  // namespace mezzotint
