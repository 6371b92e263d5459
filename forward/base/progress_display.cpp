#include "forward/base/progress_display.h"

#include <unistd.h>
#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

namespace mezzotint {

namespace {

using std::chrono::duration;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr int bar_width = 28;

std::string in_words(double total_seconds) {
  const auto whole = static_cast<long>(std::lround(total_seconds));
  if (whole < 60) return std::to_string(whole) + " s";
  if (whole < 3600) return std::to_string(whole / 60) + " min " + std::to_string(whole % 60) + " s";
  return std::to_string(whole / 3600) + " h " + std::to_string(whole % 3600 / 60) + " min";
}

}  // namespace

ProgressStyle natural_style(std::FILE* stream) {
  return ::isatty(::fileno(stream)) == 1 ? ProgressStyle::Bar : ProgressStyle::Lines;
}

ProgressDisplay::ProgressDisplay(ProgressStyle style, std::FILE* stream)
    : style_(style), stream_(stream), stage_begin_(Clock::now()), last_output_(stage_begin_) {}

ProgressDisplay::~ProgressDisplay() { finish(); }

void ProgressDisplay::finish() {
  if (bar_is_open_) std::fputc('\n', stream_);
  bar_is_open_ = false;
}

void ProgressDisplay::show(const ProgressEvent& event) {
  if (style_ == ProgressStyle::Quiet) return;
  const bool new_stage = event.stage != stage_;
  if (new_stage) {
    finish();
    stage_ = event.stage;
    stage_begin_ = Clock::now();
  }
  const auto pause = style_ == ProgressStyle::Lines ? milliseconds(10'000) : milliseconds(100);
  const bool is_due = new_stage || event.fraction >= 1.0 || Clock::now() - last_output_ >= pause;
  if (!is_due) return;
  last_output_ = Clock::now();
  if (style_ == ProgressStyle::Bar) {
    draw_bar(event);
  } else if (style_ == ProgressStyle::Lines) {
    print_line(event);
  } else {
    print_event(event);
  }
  std::fflush(stream_);
}

std::string ProgressDisplay::time_left(double fraction) const {
  const double elapsed = duration<double>(Clock::now() - stage_begin_).count();
  if (fraction >= 1.0) return "took " + in_words(elapsed);
  if (fraction < 0.01 || elapsed < 0.5) return "";
  return in_words(elapsed * (1.0 - fraction) / fraction) + " left";
}

void ProgressDisplay::draw_bar(const ProgressEvent& event) {
  const double fraction = std::clamp(event.fraction, 0.0, 1.0);
  std::string bar;
  for (int i = 0; i < bar_width; ++i) bar += i < std::lround(fraction * bar_width) ? "█" : "░";
  std::fprintf(stream_, "\r\033[K%-10s %s %3.0f %%  %s  %s", event.stage.c_str(), bar.c_str(), 100.0 * fraction,
               time_left(fraction).c_str(), event.note.c_str());
  bar_is_open_ = true;
  if (fraction >= 1.0) finish();
}

void ProgressDisplay::print_line(const ProgressEvent& event) {
  const std::string left = time_left(event.fraction);
  std::fprintf(stream_, "%s: %.0f %%%s%s%s%s\n", event.stage.c_str(), 100.0 * std::clamp(event.fraction, 0.0, 1.0),
               left.empty() ? "" : ", ", left.c_str(), event.note.empty() ? "" : ": ", event.note.c_str());
}

void ProgressDisplay::print_event(const ProgressEvent& event) {
  const nlohmann::json line = {{"event", "progress"},
                               {"stage", event.stage},
                               {"fraction", std::clamp(event.fraction, 0.0, 1.0)},
                               {"note", event.note},
                               {"seconds", duration<double>(Clock::now() - stage_begin_).count()}};
  std::fprintf(stream_, "%s\n", line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
}

}  // namespace mezzotint
