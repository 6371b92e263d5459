#pragma once

#include "fabrication/device/clock.h"

namespace mezzotint {

/// The machine's clock, a stated number of times faster: a rehearsal of a print at 1, or at 100.
class PacedClock final : public Clock {
public:
  explicit PacedClock(double pace) : pace_(pace), start_(SteadyClock().now()) {}

  [[nodiscard]] Duration now() const override { return scaled(SteadyClock().now() - start_, pace_); }
  void sleep_until(Duration time) override { SteadyClock().sleep_until(start_ + scaled(time, 1.0 / pace_)); }

private:
  static Duration scaled(Duration duration, double factor) {
    return Duration(static_cast<Duration::rep>(static_cast<double>(duration.count()) * factor));
  }
  double pace_;
  Duration start_;
};

}  // namespace mezzotint
