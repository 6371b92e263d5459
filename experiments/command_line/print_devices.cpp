#include "experiments/command_line/print_devices.h"

#include <chrono>
#include <thread>

#include "fabrication/device/virtual_light.h"
#include "fabrication/projector/usb_transport.h"
#include "fabrication/stage/marlin_stage.h"
#include "fabrication/stage/virtual_stage.h"
#include "fabrication/video/display_window.h"

namespace mezzotint {

namespace {

std::chrono::milliseconds milliseconds_of(double duration_s) {
  return std::chrono::milliseconds(static_cast<std::int64_t>(1000.0 * duration_s));
}

MarlinSettings marlin_settings(const MachineProfile& profile) {
  MarlinSettings settings;
  settings.port = profile.port;
  settings.baud = profile.baud;
  settings.boot = milliseconds_of(profile.boot_s);
  settings.answer = milliseconds_of(profile.answer_s);
  settings.homing = milliseconds_of(profile.homing_s);
  settings.tolerance_um = profile.tolerance_um;
  settings.lowest_um = profile.zero_um;
  settings.highest_um = profile.highest_um;
  return settings;
}

}  // namespace

std::unique_ptr<Stage> make_stage(const std::string& device, const Machine& machine, Clock& clock) {
  if (device == "virtual") return std::make_unique<VirtualStage>(clock, machine.profile.highest_um);
  return std::make_unique<MarlinStage>(marlin_settings(machine.profile));
}

std::unique_ptr<LightEngine> make_light(const std::string& device, const Machine& machine, const Job& frame,
                                        Clock& clock) {
  if (device == "virtual") return std::make_unique<VirtualLight>(clock, frame.columns, frame.rows);
  std::unique_ptr<LayerWindow> window;
  if (machine.projector.way == Dlpc900Options::Way::Video) {
    window = open_display_window({frame.columns, frame.rows, machine.display});
  }
  return make_dlpc900(dlpc900::open_usb({.place = machine.usb}), clock, machine.projector, std::move(window));
}

bool put_light_off(const Machine& machine) {
  SteadyClock clock;
  Dlpc900Options options = machine.projector;
  options.way = Dlpc900Options::Way::Upload;  // needs no window
  // The system may take a moment to give the device free.
  for (int attempt = 0; attempt < 20; ++attempt) {
    try {
      return make_dlpc900(dlpc900::open_usb({.place = machine.usb}), clock, options)->try_light_off();
    } catch (const DeviceError&) {
      std::this_thread::sleep_for(std::chrono::milliseconds(250));
    }
  }
  return false;
}

}  // namespace mezzotint
