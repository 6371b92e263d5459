#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "fabrication/job/uvj_layout.h"

namespace mezzotint {

namespace {

using Json = nlohmann::ordered_json;

// UVJ wants the moves between layers; our jobs leave them to the machine. These are UVtools' own defaults, for
// programs that convert the archive.
constexpr double lift_mm = 5.0;
constexpr double lift_mm_per_min = 100.0;

Json exposure_json(double seconds, int led_amplitude) {
  return {{"LightOnTime", seconds},         {"LightOffTime", 0.0},          {"LightPWM", led_amplitude},
          {"LiftHeight", lift_mm},          {"LiftSpeed", lift_mm_per_min}, {"RetractHeight", lift_mm},
          {"RetractSpeed", lift_mm_per_min}};
}

// Divided, not multiplied by 1e-3: 18 µm becomes 0.018 and not 0.018000000000000002.
double in_mm(Length length) { return length.um() / 1000.0; }

Json size_json(const Job& job) {
  const Length width = job.pixel_pitch * static_cast<double>(job.columns);
  const Length height = job.pixel_pitch * static_cast<double>(job.rows);
  return {{"X", job.columns},
          {"Y", job.rows},
          {"Millimeter", {{"X", in_mm(width)}, {"Y", in_mm(height)}}},
          {"Layers", job.layers.size()},
          {"LayerHeight", in_mm(job.layer)}};
}

// A name may come from a file name that is no valid UTF-8; JSON must be.
std::string to_text(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"; }

}  // namespace

std::string slice_member(std::size_t index) { return fmt::format("slice/{:08}.png", index); }

std::string write_config(const Job& job) {
  // The relief's layer comes last; the standard's "normal" exposure is its own. Layers overrides it anyway.
  const Json normal = exposure_json(job.layers.back().exposure_s, job.led_amplitude);
  Json bottom = exposure_json(job.layers.front().exposure_s, job.led_amplitude);
  bottom["Count"] = 0;
  Json layers = Json::array();
  for (const JobLayer& layer : job.layers) {
    layers.push_back({{"Z", in_mm(layer.top)}, {"Exposure", exposure_json(layer.exposure_s, job.led_amplitude)}});
  }
  const Json properties = {{"Size", size_json(job)}, {"Exposure", normal}, {"Bottom", bottom}, {"AntiAliasLevel", 1}};
  return to_text({{"Properties", properties}, {"Layers", layers}});
}

std::string write_manifest(const Job& job, const MemberHashes& hashes) {
  return to_text({{"format", "mezzotint print job"},
                  {"version", 1},
                  {"name", job.name},
                  {"printer", job.printer},
                  {"pixel_pitch_um", job.pixel_pitch.um()},
                  {"layer_um", job.layer.um()},
                  {"led_amplitude", job.led_amplitude},
                  {"gray_bits", 8},
                  {"first_row", "y_max"},
                  {"sha256", hashes}});
}

}  // namespace mezzotint
