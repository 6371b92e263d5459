#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fabrication/job/job.h"
#include "fabrication/session/machine_profile.h"

namespace mezzotint {

/// One layer as the machine will print it.
struct PlannedLayer {
  std::int64_t height_um = 0;  ///< of the stage
  double exposure_s = 0.0;
};

/// A job on a machine: every height and every exposure, before anything moves.
struct PrintPlan {
  std::vector<PlannedLayer> layers;
  int led_amplitude = 0;
  bool flip_columns = false, flip_rows = false;
  double largest_rounding_um = 0.0;  ///< heights are whole micrometres, each rounded by itself
};

/// @throws InvalidInput where the part is higher than the stage goes, or the profile is not valid
[[nodiscard]] PrintPlan plan_print(const Job& frame, const MachineProfile& profile);

/// Times of a print, without the loading of pictures.
struct PrintTimes {
  double light_s = 0.0;
  double moving_s = 0.0;
  double waiting_s = 0.0;
  [[nodiscard]] double total_s() const { return light_s + moving_s + waiting_s; }
};
/// Of the layers from `first` on; homing is not in it.
[[nodiscard]] PrintTimes expected_times(const PrintPlan& plan, const MachineProfile& profile, std::size_t first = 0);
/// Of one layer: approach, waits, exposure, separation.
[[nodiscard]] PrintTimes layer_times(const PlannedLayer& layer, const MachineProfile& profile);

/// A hash of all that decides what is exposed, where and for how long.
[[nodiscard]] std::string identity(const PrintPlan& plan);

}  // namespace mezzotint
