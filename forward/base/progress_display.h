#pragma once

#include <chrono>
#include <cstdio>
#include <string>

#include "forward/base/progress.h"

namespace mezzotint {

/// How progress is shown.
enum class ProgressStyle {
  Bar,     ///< one line that redraws itself, with the time that is left: for a terminal
  Lines,   ///< a line when a stage begins and ends, and every ten seconds between: for logs
  Events,  ///< one JSON object a line: for programs
  Quiet
};

/// Bar on a terminal, Lines elsewhere.
[[nodiscard]] ProgressStyle natural_style(std::FILE* stream);

/// Shows progress on a stream (stderr, so that stdout stays clean for results).
class ProgressDisplay {
public:
  ProgressDisplay(ProgressStyle style, std::FILE* stream);
  ~ProgressDisplay();
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

  void show(const ProgressEvent& event);
  /// Ends the line of a bar, so that other output can follow.
  void finish();

private:
  using Clock = std::chrono::steady_clock;
  void draw_bar(const ProgressEvent& event);
  void print_line(const ProgressEvent& event);
  void print_event(const ProgressEvent& event);
  [[nodiscard]] std::string time_left(double fraction) const;

  ProgressStyle style_;
  std::FILE* stream_;
  std::string stage_;
  Clock::time_point stage_begin_;
  Clock::time_point last_output_;
  bool bar_is_open_ = false;
};

}  // namespace mezzotint
