#pragma once

#include <cstdint>
#include <string>

namespace mezzotint {

/// Where a platform's end switch is.
enum class HomeAt {
  Top,    ///< away from the vat: homing is harmless with a part on the platform
  Bottom  ///< at the vat: homing would press a begun part into it, so it is done before the first layer only
};

/// How a machine prints: what a job does not say. The defaults are assumptions for a bottom-up printer of small fields;
/// the slides give none of these figures but the LED amplitude, which is the job's.
///
/// Frame    heights of the stage, upward; `zero_um` is where the platform touches the vat's floor
/// Units    as the names say
struct MachineProfile {
  std::string name = "machine";

  // Light.
  int led_amplitude = 0;  ///< 1…255; 0: the job's
  bool flip_columns = false;
  bool flip_rows = false;
  double exposure_tolerance = 0.02;  ///< share of an exposure up to which an interruption's length may be uncertain
  double cool_down_s = 60.0;         ///< pause after the light engine got too hot, before it is asked again
  double cool_down_limit_s = 900.0;  ///< then the print stops

  // Stage.
  std::string port = "/dev/ttyUSB0";
  int baud = 115200;
  HomeAt home_at = HomeAt::Top;
  std::int64_t zero_um = 0;
  std::int64_t highest_um = 150000;  ///< of the stage
  std::int64_t tolerance_um = 6;
  double answer_s = 3.0;
  double boot_s = 5.0;
  double homing_s = 120.0;

  // First layers: these get `bottom_exposure_s`; over the transition layers it fades linearly to the job's exposure.
  std::size_t bottom_layers = 0;
  double bottom_exposure_s = 30.0;
  std::size_t transition_layers = 0;

  // Waits.
  double before_exposure_s = 1.0;  ///< resin flows back, the platform settles
  double after_exposure_s = 0.5;
  double after_lift_s = 0.5;

  // Separation: slowly until the layer is off the floor, then faster; back the same way.
  std::int64_t slow_lift_um = 1000;
  double slow_lift_um_per_s = 500.0;
  std::int64_t fast_lift_um = 3000;
  double fast_lift_um_per_s = 2500.0;
};

/// @throws InvalidInput for figures out of their range
void require_valid(const MachineProfile& profile);

}  // namespace mezzotint
