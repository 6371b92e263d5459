#include "experiments/configuration/machine_file.h"

#include "experiments/configuration/toml_table.h"

namespace mezzotint {

namespace {

void read_projector(TomlTable table, Machine& machine) {
  MachineProfile& profile = machine.profile;
  Dlpc900Options& projector = machine.projector;
  profile.led_amplitude = static_cast<int>(table.integer("led_amplitude", 0, 255, profile.led_amplitude));
  profile.flip_columns = table.boolean("flip_columns", profile.flip_columns);
  profile.flip_rows = table.boolean("flip_rows", profile.flip_rows);
  profile.exposure_tolerance = table.number("exposure_tolerance", {0.0, 0.5}, profile.exposure_tolerance);
  profile.cool_down_s = table.number("cool_down_s", {0.1, 3600.0}, profile.cool_down_s);
  profile.cool_down_limit_s = table.number("cool_down_limit_s", {0.0, 86400.0}, profile.cool_down_limit_s);
  machine.usb = table.text("usb", machine.usb);
  machine.display = static_cast<int>(table.integer("display", -1, 63, machine.display));
  const bool is_video = table.choice("way", {"video", "upload"}, "video") == "video";
  projector.way = is_video ? Dlpc900Options::Way::Video : Dlpc900Options::Way::Upload;
  projector.video_by_sequencer = table.boolean("video_by_sequencer", projector.video_by_sequencer);
  projector.video_receiver = table.choice("video_cable", {"hdmi", "displayport"}, "displayport") == "hdmi" ? 1 : 2;
  projector.video_delay = seconds(table.number("video_delay_s", {0.0, 10.0}, in_seconds(projector.video_delay)));
  projector.leds = static_cast<unsigned>(table.integer("leds", 1, 7, projector.leds));
  projector.led_polarity_inverted = table.boolean("led_polarity_inverted", projector.led_polarity_inverted);
  projector.longest_upload =
      seconds(table.number("longest_upload_s", {0.0, 3600.0}, in_seconds(projector.longest_upload)));
  table.finish();
}

void read_stage(TomlTable table, MachineProfile& profile) {
  [[maybe_unused]] const std::string dialect = table.choice("dialect", {"marlin"}, "marlin");
  profile.port = table.text("port", profile.port);
  profile.baud = static_cast<int>(table.integer("baud", 300, 4000000, profile.baud));
  profile.home_at = table.choice("home", {"top", "bottom"}, "top") == "top" ? HomeAt::Top : HomeAt::Bottom;
  profile.zero_um = table.integer("zero_um", -1000000, 1000000, profile.zero_um);
  profile.highest_um = table.integer("highest_um", 1000, 2000000, profile.highest_um);
  profile.tolerance_um = table.integer("tolerance_um", 0, 1000, profile.tolerance_um);
  profile.answer_s = table.number("answer_s", {0.01, 600.0}, profile.answer_s);
  profile.boot_s = table.number("boot_s", {0.01, 600.0}, profile.boot_s);
  profile.homing_s = table.number("homing_s", {0.1, 3600.0}, profile.homing_s);
  table.finish();
}

void read_layers(TomlTable bottom, TomlTable wait, TomlTable lift, MachineProfile& profile) {
  profile.bottom_layers = static_cast<std::size_t>(bottom.integer("layers", 0, 1000, 0));
  profile.bottom_exposure_s = bottom.number("exposure_s", {1e-3, 3600.0}, profile.bottom_exposure_s);
  profile.transition_layers = static_cast<std::size_t>(bottom.integer("transition_layers", 0, 1000, 0));
  bottom.finish();
  profile.before_exposure_s = wait.number("before_exposure_s", {0.0, 600.0}, profile.before_exposure_s);
  profile.after_exposure_s = wait.number("after_exposure_s", {0.0, 600.0}, profile.after_exposure_s);
  profile.after_lift_s = wait.number("after_lift_s", {0.0, 600.0}, profile.after_lift_s);
  wait.finish();
  profile.slow_lift_um = lift.integer("slow_um", 0, 100000, profile.slow_lift_um);
  profile.slow_lift_um_per_s = lift.number("slow_um_per_s", {1.0, 1e5}, profile.slow_lift_um_per_s);
  profile.fast_lift_um = lift.integer("fast_um", 0, 100000, profile.fast_lift_um);
  profile.fast_lift_um_per_s = lift.number("fast_um_per_s", {1.0, 1e5}, profile.fast_lift_um_per_s);
  lift.finish();
}

}  // namespace

Machine read_machine(const std::filesystem::path& path) {
  const TomlFile file(path);
  TomlTable table(file);
  Machine machine;
  machine.profile.name = table.text("name", path.stem().string());
  read_projector(table.table("projector"), machine);
  read_stage(table.table("stage"), machine.profile);
  read_layers(table.table("bottom"), table.table("wait"), table.table("lift"), machine.profile);
  table.finish();
  try {
    require_valid(machine.profile);
  } catch (const InvalidInput& error) {
    throw ConfigurationError(path.string() + ": " + error.what());
  }
  return machine;
}

}  // namespace mezzotint
