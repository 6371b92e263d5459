#pragma once

#include <cmath>

#include "fabrication/device/clock.h"
#include "fabrication/stage/stage.h"

namespace mezzotint {

/// A platform of numbers that takes its time: the virtual printer's. It is always where it was sent.
class VirtualStage final : public Stage {
public:
  /// @param clock  outlives the stage
  VirtualStage(Clock& clock, std::int64_t home_um) : clock_(clock), home_um_(home_um), height_um_(home_um) {}

  void home() override {
    height_um_ = home_um_;
    homed_ = true;
  }
  [[nodiscard]] bool is_homed() const override { return homed_; }
  void move_to(std::int64_t height_um, double speed_um_per_s) override {
    if (!homed_) throw StageError(StageFault::PositionLost, "the virtual stage is not homed");
    clock_.sleep_for(seconds(std::abs(static_cast<double>(height_um - height_um_)) / speed_um_per_s));
    height_um_ = height_um;
  }
  [[nodiscard]] std::int64_t height_um() override { return height_um_; }

private:
  Clock& clock_;
  std::int64_t home_um_, height_um_;
  bool homed_ = false;
};

}  // namespace mezzotint
