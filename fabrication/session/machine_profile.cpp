#include "fabrication/session/machine_profile.h"

#include <fmt/format.h>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

void require_range(double value, double low, double high, const char* name) {
  require(value >= low && value <= high,
          fmt::format("{} is {}; it must lie between {} and {}", name, value, low, high));
}

}  // namespace

void require_valid(const MachineProfile& profile) {
  require_range(profile.led_amplitude, 0, 255, "led_amplitude");
  require_range(profile.exposure_tolerance, 0.0, 0.5, "exposure_tolerance");
  require_range(profile.cool_down_s, 0.1, 3600.0, "cool_down_s");
  require_range(profile.cool_down_limit_s, 0.0, 86400.0, "cool_down_limit_s");
  require_range(double(profile.zero_um), -1e6, 1e6, "zero_um");
  require_range(double(profile.highest_um), 1000, 2e6, "highest_um");
  require(profile.highest_um > profile.zero_um, "highest_um must lie over zero_um");
  require_range(double(profile.tolerance_um), 0, 1000, "tolerance_um");
  require_range(profile.answer_s, 0.01, 600.0, "answer_s");
  require_range(profile.boot_s, 0.01, 600.0, "boot_s");
  require_range(profile.homing_s, 0.1, 3600.0, "homing_s");
  require_range(double(profile.bottom_layers), 0, 1000, "bottom layers");
  require_range(double(profile.transition_layers), 0, 1000, "transition_layers");
  require(profile.transition_layers == 0 || profile.bottom_layers > 0, "transition_layers need bottom layers");
  require_range(profile.bottom_exposure_s, 1e-3, 3600.0, "bottom exposure_s");
  require_range(profile.before_exposure_s, 0.0, 600.0, "before_exposure_s");
  require_range(profile.after_exposure_s, 0.0, 600.0, "after_exposure_s");
  require_range(profile.after_lift_s, 0.0, 600.0, "after_lift_s");
  require_range(double(profile.slow_lift_um), 0, 100000, "slow_um");
  require_range(double(profile.fast_lift_um), 0, 100000, "fast_um");
  require(profile.slow_lift_um + profile.fast_lift_um > 0,
          "the lift separates nothing: slow_um + fast_um must be over 0");
  require_range(profile.slow_lift_um_per_s, 1.0, 1e5, "slow_um_per_s");
  require_range(profile.fast_lift_um_per_s, 1.0, 1e5, "fast_um_per_s");
}

}  // namespace mezzotint
