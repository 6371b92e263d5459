#include "fabrication/session/print_plan.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "forward/base/digest.h"
#include "forward/base/error.h"

namespace mezzotint {

namespace {

double planned_exposure(std::size_t index, double own_s, const MachineProfile& profile) {
  if (index < profile.bottom_layers) return profile.bottom_exposure_s;
  const std::size_t step = index - profile.bottom_layers + 1;
  if (step > profile.transition_layers) return own_s;
  const double faded = double(step) / double(profile.transition_layers + 1);
  return profile.bottom_exposure_s + (own_s - profile.bottom_exposure_s) * faded;
}

}  // namespace

PrintPlan plan_print(const Job& frame, const MachineProfile& profile) {
  require_valid(profile);
  require(!frame.layers.empty(), "the job has no layers");
  PrintPlan plan;
  plan.led_amplitude = profile.led_amplitude > 0 ? profile.led_amplitude : frame.led_amplitude;
  plan.flip_columns = profile.flip_columns;
  plan.flip_rows = profile.flip_rows;
  std::int64_t before = profile.zero_um;
  for (std::size_t index = 0; index < frame.layers.size(); ++index) {
    const double top_um = frame.layers[index].top.um();
    require(std::abs(top_um) < 1e7, fmt::format("layer {} lies {} µm over the platform", index, top_um));
    const std::int64_t height = profile.zero_um + std::llround(top_um);
    require(height > before, fmt::format("layer {} is thinner than the stage's step of 1 µm", index));
    before = height;
    plan.largest_rounding_um = std::max(plan.largest_rounding_um, std::abs(top_um - std::round(top_um)));
    plan.layers.push_back({height, planned_exposure(index, frame.layers[index].exposure_s, profile)});
  }
  const std::int64_t lifted = before + profile.slow_lift_um + profile.fast_lift_um;
  require(lifted <= profile.highest_um,
          fmt::format("the last layer is lifted to {} µm, but the stage goes to {} µm; is the part too high?", lifted,
                      profile.highest_um));
  return plan;
}

PrintTimes layer_times(const PlannedLayer& layer, const MachineProfile& profile) {
  const double lift_s = double(profile.slow_lift_um) / profile.slow_lift_um_per_s +
                        double(profile.fast_lift_um) / profile.fast_lift_um_per_s;
  return {layer.exposure_s, 2.0 * lift_s, profile.before_exposure_s + profile.after_exposure_s + profile.after_lift_s};
}

PrintTimes expected_times(const PrintPlan& plan, const MachineProfile& profile, std::size_t first) {
  PrintTimes sum;
  for (std::size_t index = first; index < plan.layers.size(); ++index) {
    const PrintTimes times = layer_times(plan.layers[index], profile);
    sum.light_s += times.light_s;
    sum.moving_s += times.moving_s;
    sum.waiting_s += times.waiting_s;
  }
  return sum;
}

std::string identity(const PrintPlan& plan) {
  std::string text = fmt::format("{} {} {}", plan.led_amplitude, plan.flip_columns, plan.flip_rows);
  for (const PlannedLayer& layer : plan.layers) text += fmt::format("\n{} {:.9g}", layer.height_um, layer.exposure_s);
  return sha256_hex(std::as_bytes(std::span(text.data(), text.size())));
}

}  // namespace mezzotint
