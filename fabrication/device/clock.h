#pragma once

#include <chrono>
#include <thread>

namespace mezzotint {

/// The clock that exposures, deadlines and waits go by: the machine's own, or one that a test moves.
///
/// Units    nanoseconds since a start that means nothing by itself; never runs backward.
class Clock {
public:
  using Duration = std::chrono::nanoseconds;

  virtual ~Clock() = default;
  [[nodiscard]] virtual Duration now() const = 0;
  /// Returns when `now()` has reached `time`, at once where it has.
  virtual void sleep_until(Duration time) = 0;

  void sleep_for(Duration duration) { sleep_until(now() + duration); }
};

/// The machine's monotonic clock.
class SteadyClock final : public Clock {
public:
  [[nodiscard]] Duration now() const override {
    return std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now().time_since_epoch());
  }
  void sleep_until(Duration time) override {
    std::this_thread::sleep_until(std::chrono::steady_clock::time_point(time));
  }
};

/// A clock that moves when someone sleeps, and only then: hours of printing pass in no time.
class VirtualClock final : public Clock {
public:
  [[nodiscard]] Duration now() const override { return now_; }
  void sleep_until(Duration time) override {
    if (time > now_) now_ = time;
  }

private:
  Duration now_{0};
};

/// Seconds of a file or a profile as a duration, to the nanosecond.
[[nodiscard]] inline Clock::Duration seconds(double value) {
  return std::chrono::duration_cast<Clock::Duration>(std::chrono::duration<double>(value));
}
[[nodiscard]] inline double in_seconds(Clock::Duration value) { return std::chrono::duration<double>(value).count(); }

}  // namespace mezzotint
